// MeshPlanner: which chunk to mesh next, and from what. Pure; the threads are MeshPool's.
//   - changes of one chunk are joined until it is meshed; it has one job at a time, and what changes meanwhile
//     is for the next;
//   - a chunk waits for neighbours that are in view and not here yet; beyond the view, or where the server
//     has none to send, a missing neighbour means that the faces at the edge are drawn, and the chunk is
//     meshed again should the neighbour come; an edited chunk does not wait at all, so that no edit is seen
//     late because terrain is;
//   - a change at the border meshes the neighbour again too;
//   - first chunks of which layers changed, then other edited ones, then the nearest to the eye.
// The newest mesh of each chunk is kept, and with it the layers that changed since its job was made; the next
// job takes both along, so that only those layers are meshed again. The news of the replica are the one
// source of these layers: whatever replaces shown runs (a prediction, one taken back, a commit, a snapshot)
// passes there, with all layers between the old runs and the new. A chunk is meshed as a whole where that
// does not describe the way from the kept mesh to the picture of now: there is no mesh yet, the chunk or a
// neighbour came, went or came back since, the axis order is another, or there are news not yet taken.
// One thread. Cost: O(log chunks) a change or job, O(chunks to mesh) when the eye crosses into another chunk.
// Memory: kept_bytes(), and some 500 bytes a chunk in view.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include "client/replica/replica.hpp"
#include "client/replica/replica_changes.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// Null: none.
using MeshPtr = std::shared_ptr<const ChunkMesh>;

struct MeshJob {
  ChunkKey key;
  std::uint64_t number = 0;  // rises with every job
  std::uint64_t serial = 0;  // Replica::shown_serial() of what is meshed
  ShownPtr chunk;
  std::array<ShownPtr, kDirectionCount> neighbours;  // null: beyond the view
  /// The mesh to start from, and the layers that changed since, as mesh_rdm_layers() wants them. Null: mesh
  /// the whole chunk.
  MeshPtr before;
  VisibleLayers changed;
};

enum class JobSize : std::uint8_t {
  any,
  layers,  // a mesh is kept, of which layers are to be made anew: some 10 us
};

class MeshPlanner {
 public:
  explicit MeshPlanner(const Replica& replica) : replica_(replica) {}

  void take(std::span<const ChunkChange> changes);
  /// The view of the replica moved: chunks at its edge may not wait any longer.
  void view_changed();
  void set_eye(ChunkCoord eye);

  /// The next job of this size; none while everything left waits for a neighbour or for a result. Every job must be
  /// finished, or made void.
  std::optional<MeshJob> next(JobSize size = JobSize::any);
  /// Takes the mesh of a job that is done, and keeps it. Returns whether it should be drawn: not if its chunk
  /// left the view since, even if it came back, or if the job was made void.
  bool finish(const ChunkKey& key, std::uint64_t number, MeshPtr mesh);
  /// No mesh holds any more, nor will that of any job out: materials look different now. Meshes all again.
  void forget_meshes();

  /// Chunks to mesh, and those of them that need not wait.
  std::size_t dirty_count() const { return dirty_; }
  std::size_t ready_count() const { return ready_.size(); }
  std::uint64_t jobs() const { return jobs_; }
  /// Chunks that got at least one job. jobs() / this is the number of meshes per chunk.
  std::uint64_t chunks_meshed() const { return chunks_; }
  /// Bytes of the meshes kept at the moment. O(chunks).
  std::size_t kept_bytes() const;

 private:
  using Rank = std::tuple<int, std::int64_t, ChunkKey>;
  struct State {
    bool dirty = false;
    bool edited = false;
    bool edited_in_job = false;  // and not meshed yet if that job is made void
    bool counted = false;        // in chunks_
    std::uint64_t job = 0;       // under way; 0: none
    std::uint64_t serial = 0;    // of the newest news
    VisibleLayers changed;       // since the newest job was made
    // What that job was made from, and its mesh: null while it is under way, and where nothing is known of it.
    AxisOrder order{};
    std::uint8_t open_sides = 0;  // bit per Direction: there was no neighbour
    MeshPtr mesh;
    std::optional<Rank> rank;  // place in ready_
  };
  bool ready(const ChunkKey& key, const State& state) const;
  void mark(const ChunkKey& key, State& state);
  void mark_whole(const ChunkKey& key, State& state);
  void place(const ChunkKey& key, State& state);
  template <class Act>
  void for_each_beside(const ChunkKey& key, Act act);

  const Replica& replica_;
  ChunkCoord eye_;
  std::map<ChunkKey, State> states_;
  std::set<Rank> ready_;
  std::size_t dirty_ = 0;
  std::uint64_t jobs_ = 0, chunks_ = 0;
};

}  // namespace runstone
