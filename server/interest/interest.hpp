// Interest: which session sees which chunk. It keeps the interest of each session and, for each
// chunk, its subscribers and the sessions that wait for it. So finding the receivers of a commit
// costs O(subscribers of the chunks it changed). A session is subscribed in the same task of the
// world strand that takes the snapshot's version, so it misses no commit after its snapshot. One
// thread.
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "server/interest/chunk_hash_map.hpp"
#include "server/interest/session_interest.hpp"

namespace runstone {

class Interest {
 public:
  explicit Interest(CoordLimit limit) : limit_(limit) {}

  /// Adds a session without a view. Requires that it was not added before.
  void open(SessionId session);
  /// Removes the session, if it is known.
  void close(SessionId session);
  /// Returns null if the session is unknown.
  const SessionInterest* find(SessionId session) const;

  // The calls down to set_state() require an open session.

  /// Sets the session's view. Returns how many chunks it visited: the cost of the call.
  std::size_t set_view(SessionId session, const View& view);
  /// Makes all chunks wanted again. Returns their number.
  std::size_t want_all_again(SessionId session);
  /// Makes the chunks wanted again that lie outside of at least one of these views. It is for a
  /// client that had these views in between and may have dropped those chunks. Returns their
  /// number.
  std::size_t want_again_outside(SessionId session, std::span<const View> views);
  std::optional<ChunkKey> nearest_wanted(SessionId session);
  std::optional<ChunkKey> next_for_digest_check(SessionId session);
  /// Moves a chunk to a state. Returns false if it is not in the session's view.
  bool set_state(SessionId session, const ChunkKey& key, ChunkInterest state);

  /// Returns the subscribers of a chunk, ascending. The span is valid until the next change.
  std::span<const SessionId> subscribers(const ChunkKey& key) const;
  /// Returns a copy of the sessions that wait for a chunk, because the caller changes their states.
  std::vector<SessionId> waiting(const ChunkKey& key) const;
  bool subscribes(SessionId session, const ChunkKey& key) const;
  /// Returns true if a session is subscribed to the chunk or waits for it.
  bool is_used(const ChunkKey& key) const { return users_.contains(key); }
  std::size_t used_count() const { return users_.size(); }
  /// Removes and returns chunks that lost their last user, at most `count`, the earliest first.
  /// Some may have a new one.
  std::vector<ChunkKey> take_released(std::size_t count);

 private:
  struct Users {
    std::vector<SessionId> subscribers;  // ascending, so that broadcast merges them in one pass
    std::vector<SessionId> waiting;      // in the order of their requests
  };
  void leave(SessionId session, const ChunkKey& key, ChunkInterest was);
  void enter(SessionId session, const ChunkKey& key, ChunkInterest now);
  SessionInterest& at(SessionId session);
  /// Makes the chunks wanted again for which `is_meant` returns true; it takes a ChunkCoord.
  template <class IsMeant>
  std::size_t want_again(SessionId session, IsMeant is_meant);

  CoordLimit limit_;
  std::map<SessionId, SessionInterest> sessions_;
  ChunkHashMap<Users> users_;  // no entry is empty
  std::deque<ChunkKey> released_;
};

}  // namespace runstone
