// MeshPlanner: which chunk to mesh next, and from what. Pure; the threads are MeshPool's.
//   - changes of one chunk are joined until it is meshed (the newest runs win; older results are dropped);
//   - a chunk waits for neighbours that are in view and not here yet; beyond the view, or where the server
//     has none to send, a missing neighbour means that the faces at the edge are drawn, and the chunk is
//     meshed again should the view grow past it;
//   - a change at the border meshes the neighbour again too;
//   - edited chunks first, then the nearest to the eye.
// One thread. Cost: O(log chunks) a change or job, O(chunks to mesh) when the eye crosses into another chunk.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include "client/replica/replica.hpp"
#include "client/replica/replica_news.hpp"
#include "common/core/coords.hpp"

namespace runstone {

struct MeshJob {
  ChunkKey key;
  std::uint64_t number = 0;  // rises with every job: of two results for a chunk the higher one wins
  std::uint64_t serial = 0;  // Replica::shown_serial() of what is meshed
  ShownPtr chunk;
  std::array<ShownPtr, kDirectionCount> neighbours;  // null: beyond the view
};

class MeshPlanner {
 public:
  explicit MeshPlanner(const Replica& replica) : replica_(replica) {}

  void take(std::span<const ChunkNews> news);
  /// The view of the replica moved: chunks at its edge may not wait any longer.
  void view_changed();
  void set_eye(ChunkCoord eye);

  /// The next job; none while everything left waits for a neighbour.
  std::optional<MeshJob> next();
  /// Whether the result of this job should be drawn: its chunk is in view and nothing newer was drawn.
  /// A true answer is remembered as drawn.
  bool accept(const ChunkKey& key, std::uint64_t number);

  /// Chunks to mesh, and those of them that need not wait.
  std::size_t dirty_count() const { return dirty_; }
  std::size_t ready_count() const { return ready_.size(); }
  std::uint64_t jobs() const { return jobs_; }
  /// Chunks that got at least one job. jobs() / this is the number of meshes per chunk.
  std::uint64_t chunks_meshed() const { return chunks_; }

 private:
  using Rank = std::tuple<int, std::int64_t, ChunkKey>;
  struct State {
    bool dirty = false;
    bool edited = false;
    std::uint8_t open_sides = 0;  // bit per Direction: the last job had no neighbour there
    std::uint64_t job = 0;        // newest job; 0: none yet
    std::uint64_t drawn = 0;      // newest job accepted
    std::optional<Rank> rank;     // place in ready_
  };
  bool ready(const ChunkKey& key) const;
  void mark(const ChunkKey& key, State& state, bool edited);
  void place(const ChunkKey& key, State& state);
  void place_neighbours(const ChunkKey& key);

  const Replica& replica_;
  ChunkCoord eye_;
  std::map<ChunkKey, State> states_;
  std::set<Rank> ready_;
  std::size_t dirty_ = 0;
  std::uint64_t jobs_ = 0, chunks_ = 0;
};

}  // namespace runstone
