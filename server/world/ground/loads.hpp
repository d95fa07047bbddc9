// Loads: chunks that workers load, for sessions and for the world itself, and what keeps the memory
// that they take within its bounds (server/world/order/world_memory.hpp).
// Thread: the world strand.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "server/world/ground/ground_base.hpp"
#include "server/world/ground/load_queue.hpp"
#include "server/world/ground/load_retries.hpp"

namespace runstone {

class Loads {
 public:
  explicit Loads(GroundBase& base) : base_(base), queue_(base.config.loads_in_flight_max) {}

  /// Queues a load that the world itself needs, and starts what may start. Does nothing unless the
  /// chunk is absent.
  void request(const ChunkKey& key, const Clocks& now);
  /// Queues a load for a session. It is paid by the session's player (Quotas::pay_load()).
  void request_for(const Viewer& viewer, const ChunkKey& key) { queue_.request(viewer.id(), key); }
  /// Starts queued loads, up to loads_in_flight_max.
  void start(const Clocks& now);
  /// Removes a load of a session, because another one has brought the chunk.
  void cancel(SessionId session, const ChunkKey& key) { queue_.cancel(session, key); }
  /// Removes all loads of a session, and returns their chunks.
  std::vector<ChunkKey> cancel(SessionId session) { return queue_.cancel(session); }
  /// Removes all loads that only the world needs.
  void cancel_for_world() { queue_.cancel_for_world(); }

  /// Counts the end of a load, if the chunk is loading.
  void ended(const ChunkKey& key);
  /// Loads a chunk again after a pause. Returns false after too many failures in a row.
  bool load_again(const ChunkKey& key, OperatorLogLevel level, const std::string& why,
                  const Clocks& now);
  /// Forgets that loads of a chunk failed.
  void forget_failures(const ChunkKey& key) { retries_.ended(key); }
  /// Loads chunks again whose pause has ended. Their residency stayed `loading`.
  void retry(const Clocks& now);
  /// Ends every pause, and lets the next failure of each chunk be its last.
  void hurry() { retries_.hurry(); }

  /// Makes chunks that lost their last user candidates for eviction: some thousands, and the others
  /// with the next calls.
  void collect_released();
  /// Makes chunks without users leave memory, lets the sessions wait whose address sees more than
  /// its share, and warns the operator when the memory is full and when it is no longer. Call it on
  /// each tick.
  void keep_memory_bounds();

 private:
  std::size_t mean_chunk_bytes() const;
  std::set<SessionId> sessions_over_share(const WorldMemory& use) const;

  GroundBase& base_;
  LoadQueue queue_;
  LoadRetries retries_;
  // Sessions for which no chunk is loaded until the next tick, because their address sees more than
  // its share of the memory, or because a budget is used up.
  std::set<SessionId> waiting_;
  bool is_memory_short_ =
      false;  // as of the last tick: all sessions wait for memory to load chunks
};

}  // namespace runstone
