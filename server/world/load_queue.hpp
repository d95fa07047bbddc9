// LoadQueue: chunks that have to be loaded, and whose turn it is. A few loads are with the workers at a time;
// all others wait here, on the world strand, where they can still be taken back. Sessions take turns, each
// with the chunks it asked for in its order (nearest first); the world's own needs (snapshot rounds, long
// stacks) take turns like one more session. A key may wait in several lanes; whoever takes it from the queue
// sees whether it is on its way already. Bounded by what its owner asks for: loads_per_session_max for a
// session, the edited chunks for the world. One thread (the world strand).
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
  /// `in_flight_max`: loads with the workers at a time, at least one.
  explicit LoadQueue(std::size_t in_flight_max) : in_flight_max_(in_flight_max) {}

  /// Puts a key behind the session's others. The session must not wait for it already.
  void ask(SessionId session, const ChunkKey& key);
  /// The world itself needs the chunk. Asking twice is asking once.
  void ask_own(const ChunkKey& key) { own_.insert(key); }
  /// The session does not wait for it any more; unknown keys are allowed. O(keys of the session).
  void take_back(SessionId session, const ChunkKey& key);
  /// Takes back all that the session waits for, in its order.
  std::vector<ChunkKey> take_back(SessionId session);

  /// Takes out the key whose turn it is; nothing while enough loads are under way, or if none waits.
  std::optional<ChunkKey> next();
  /// A load was handed to the workers; it ended.
  void began() { ++in_flight_; }
  void ended();

  std::size_t in_flight() const { return in_flight_; }

 private:
  std::size_t in_flight_max_;
  std::size_t in_flight_ = 0;
  std::map<SessionId, std::deque<ChunkKey>> lanes_;  // never empty ones
  std::set<ChunkKey> own_;
  std::optional<SessionId> served_;  // whose turn was last; nothing: the world's own
};

}  // namespace runstone
