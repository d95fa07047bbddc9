// MeshPlanner: decides which chunk is meshed next, and from what. Pure; MeshPool has the threads.
//   - Changes of one chunk are merged until it is meshed. A chunk has one job at a time; later
//     changes are for the next job.
//   - A chunk waits for neighbours that are in view and have not arrived. Beyond the view, or where
//     the server has no chunk, a missing neighbour means that the faces at that border are drawn.
//     If the neighbour arrives later or leaves, the chunk is meshed again.
//   - An edited chunk does not wait, so that late terrain does not delay an edit.
//   - A change at a border also meshes the neighbour again.
//   - The order is: chunks of which layers changed, other edited chunks, then the nearest to the
//     eye. Among edited chunks, those with an edit of this client come first.
//
// The planner keeps the newest mesh of each chunk, and the layers that changed since its job was
// made. The next job takes both, so that only those layers are meshed again. The changes of the
// replica are the only source of these layers: whatever replaces shown runs (a prediction, its
// removal, a commit, a snapshot) queues all layers that differ. A chunk is meshed as a whole if the
// kept mesh and these layers do not give its present mesh:
//   - it has no mesh yet;
//   - the chunk or a neighbour arrived, left, or came back since;
//   - the axis order changed;
//   - there are changes that take() has not got yet.
//
// It also keeps the borders that a mesh of a whole chunk has made, for the later meshes beside it.
//
// One thread. Cost: O(log chunks) per change or job; O(chunks to mesh) when the eye enters another
// chunk. Memory: kept_bytes(), and about 500 bytes per chunk in view.
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
#include "client/schedule/kept_borders.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/runs/axis_order.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

/// The pointer is null if there is no mesh.
using MeshPtr = std::shared_ptr<const ChunkMesh>;
/// Returns the memory of a mesh, its unused capacity included. Chunks without quads share one, which
/// counts as nothing.
std::size_t mesh_bytes(const MeshPtr& mesh);

struct MeshJob {
  ChunkKey key;
  std::uint64_t number = 0;  // rises with every job
  std::uint64_t serial = 0;  // Replica::shown_serial() of the meshed runs
  ShownPtr chunk;
  std::array<ShownPtr, kDirectionCount> neighbours;  // null: beyond the view, or unavailable
  std::array<BordersPtr, kDirectionCount> borders;   // of the neighbours; null: none are kept
  /// The mesh to start from, and the layers that changed since, as arguments of mesh_rdm_layers().
  /// Null if the whole chunk is to be meshed.
  MeshPtr before;
  ChangedLayers changed;
  Urgency urgency = Urgency::terrain;  // of the changes that the mesh shows
};

/// Returns a bound of the quads that meshing a chunk with these runs makes, in bytes, as far as its
/// own runs determine it:
///   - A run of cubes that alternates with air has three faces on average. Runs of the neighbours
///     can cut faces at the border further.
///   - A run of a shape has all faces of each voxel. All shapes of a chunk have kShapeQuadsMax at
///     most.
/// Cost: O(1) if no material has a shape, otherwise O(runs).
std::size_t mesh_bytes_about(const MeshJob& job, const ShapeTable& shapes);

enum class JobSize : std::uint8_t {
  any,
  layers,  // only jobs that start from a kept mesh: about 10 us each
};

class MeshPlanner {
 public:
  explicit MeshPlanner(const Replica& replica) : replica_(replica) {}

  void take(std::span<const ChunkChange> changes);
  /// Call it when the view of the replica moved. Chunks at its edge may not have to wait any
  /// longer.
  void view_changed();
  void set_eye(ChunkCoord eye);

  /// Returns the next job of this size, or nullopt while every chunk left waits for a neighbour or
  /// a result. Pass its mesh to finish(), unless forget_meshes() made the job void.
  std::optional<MeshJob> next(JobSize size = JobSize::any);
  /// Takes and keeps the mesh of a finished job, and the borders of its chunk `runs` if it made
  /// them. Returns true if the mesh should be drawn. Returns false if the chunk has left the view
  /// since, even if it came back, or if the job was made void.
  bool finish(const ChunkKey& key, std::uint64_t number, MeshPtr mesh,
              const ShownPtr& runs = nullptr, BordersPtr borders = nullptr);
  /// Drops all meshes and makes all open jobs void, because materials look different now. Every
  /// chunk is meshed again.
  void forget_meshes();
  /// Drops the meshes and makes the jobs void of the chunks that have a material from `first` on,
  /// and of those beside them. Cost: O(runs of all chunks).
  void mesh_again_from(Material first);

  /// Return the number of chunks to mesh, and the number of those that do not have to wait.
  std::size_t dirty_count() const { return dirty_; }
  std::size_t ready_count() const { return ready_.size(); }
  std::uint64_t jobs() const { return jobs_; }
  /// Returns the number of chunks that got at least one job. jobs() divided by it is the number of
  /// meshes per chunk.
  std::uint64_t chunks_meshed() const { return chunks_; }
  /// Returns the size of the kept meshes and borders, in bytes.
  std::size_t kept_bytes() const { return kept_bytes_ + borders_.bytes(); }

 private:
  using Rank = std::tuple<int, int, std::int64_t, ChunkKey>;
  struct State {
    bool dirty = false;
    Urgency urgency = Urgency::terrain;         // of the changes since the newest job was made
    Urgency urgency_in_job = Urgency::terrain;  // those of the job, which count again if it is void
    bool counted = false;                       // counted in chunks_
    std::uint64_t job = 0;                      // number of the open job; 0: none
    std::uint64_t serial = 0;                   // of the newest change
    ChangedLayers changed;                      // since the newest job was made
    // The sources of the newest job, and its mesh. The mesh is null while the job is open or void.
    AxisOrder order{};
    std::uint8_t open_sides = 0;  // bit per Direction: there was no neighbour
    MeshPtr mesh;
    std::optional<Rank> rank;  // place in ready_
  };
  bool ready(const ChunkKey& key, const State& state) const;
  void mark(const ChunkKey& key, State& state);
  void mark_whole(const ChunkKey& key, State& state);
  void place(const ChunkKey& key, State& state);
  /// Replaces the kept mesh. Returns the one before.
  MeshPtr keep(State& state, MeshPtr mesh);
  template <class Act>
  void for_each_beside(const ChunkKey& key, Act act);

  const Replica& replica_;
  ChunkCoord eye_;
  std::map<ChunkKey, State> states_;
  std::set<Rank> ready_;
  std::size_t dirty_ = 0;
  std::size_t kept_bytes_ = 0;  // of meshes
  KeptBorders borders_;
  std::uint64_t jobs_ = 0, chunks_ = 0;
};

}  // namespace runstone
