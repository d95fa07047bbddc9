// LoadQueue: the chunks that must be loaded, and the order in which workers load them. A few loads
// are with the workers at a time; all others wait here and can be cancelled. The sessions are
// served round robin, each with its chunks in the order of its requests. The world, which needs
// chunks for checkpoints and long edit stacks, is served like one more session. A key may wait for
// several sessions; the caller of next() checks whether the chunk is already loading.
// Bound: loads_per_session_max for each session, the edited chunks for the world.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class LoadQueue {
 public:
  /// `in_flight_max`: loads with the workers at a time, at least 1.
  explicit LoadQueue(std::size_t in_flight_max) : in_flight_max_(in_flight_max) {}

  /// Queues a key behind the session's other keys. Requires that the session does not wait for it.
  void request(SessionId session, const ChunkKey& key);
  /// Queues a key that the world needs. Does nothing if the world waits for it already.
  void request_for_world(const ChunkKey& key) { world_keys_.insert(key); }
  /// Removes all keys that only the world needs.
  void cancel_for_world() { world_keys_.clear(); }
  /// Removes a key of the session, if it waits. Cost: O(keys of the session).
  void cancel(SessionId session, const ChunkKey& key);
  /// Removes and returns all keys of the session, in its order.
  std::vector<ChunkKey> cancel(SessionId session);

  struct Next {
    ChunkKey key;
    std::optional<SessionId> session;  // nullopt: the world needs it
  };
  /// Removes and returns the next key. Returns nullopt if none waits or in_flight_max loads are
  /// under way. Skips the sessions that must wait.
  std::optional<Next> next(const std::set<SessionId>& must_wait = {});
  /// Removes and returns the next key that the world needs. Returns nullopt if none waits or
  /// in_flight_max loads are under way.
  std::optional<Next> next_for_world();
  /// Queues a key that next() returned before the session's other keys.
  void put_back(SessionId session, const ChunkKey& key) { lanes_[session].push_front(key); }
  /// Counts a load that workers begin or have ended.
  void load_started() { ++in_flight_; }
  void load_ended();

  std::size_t in_flight() const { return in_flight_; }

 private:
  std::size_t in_flight_max_;
  std::size_t in_flight_ = 0;
  std::map<SessionId, std::deque<ChunkKey>> lanes_;  // no lane is empty
  std::set<ChunkKey> world_keys_;
  std::optional<SessionId> last_served_;  // nullopt: the world was served last
};

}  // namespace runstone
