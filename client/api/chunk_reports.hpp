// ChunkReports: reports the chunks of a replica that the program has to mesh again, and the chunks
// whose meshes it has to remove. A MeshPlanner decides this, as in runstone-client, so a neighbour
// that arrives, changes or leaves also makes a mesh outdated. Thread: one.
#pragma once
#include <cstddef>
#include <optional>
#include <set>
#include <span>

#include "client/api/event_queue.hpp"
#include "client/replica/replica.hpp"
#include "client/schedule/mesh_planner.hpp"

namespace runstone {

class ChunkReports {
 public:
  /// `replica` must outlive the reports.
  explicit ChunkReports(const Replica& replica) : replica_(replica), planner_(replica) {}

  /// Takes the changes of the replica. Queues ChunkRemoved for each chunk that was reported and is
  /// not shown any more.
  void take(std::span<const ChunkChange> changes, EventQueue& events);
  /// Call it when the view of the replica has moved, or when the answers of the replica for chunks
  /// at the edge have changed.
  void view_changed() { planner_.view_changed(); }
  void set_eye(ChunkCoord eye) { planner_.set_eye(eye); }
  /// Reports again the chunks that have a material from `first` on.
  void mesh_again_from(Material first) { planner_.mesh_again_from(first); }
  /// Reports all chunks again, because shapes of materials changed.
  void mesh_all_again() { planner_.forget_meshes(); }

  /// Returns the next chunk to mesh, or nullopt if each chunk is up to date or waits for a
  /// neighbour.
  std::optional<ChunkChanged> next();
  /// Returns the number of chunks to mesh.
  std::size_t count() const { return planner_.dirty_count(); }
  /// Returns the chunk and its neighbours as they are shown, or nullopt if it is not shown.
  std::optional<MeshSource> source(ChunkCoord at) const;

 private:
  const Replica& replica_;
  MeshPlanner planner_;
  std::set<ChunkCoord> reported_;  // by ChunkChanged, and not removed since
};

}  // namespace runstone
