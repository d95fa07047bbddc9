// Interest: who sees which chunk. Keeps each session's interest and, per chunk, its subscribers and those who
// wait for it, so that the receivers of a commit cost O(subscribers of the chunks it changed).
// Subscribing and taking the snapshot's version happen in one step of the world strand; therefore a session
// misses no commit after its snapshot. One thread.
#pragma once
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "server/interest/chunk_key_hash.hpp"
#include "server/interest/session_interest.hpp"

namespace runstone {

class Interest {
 public:
  explicit Interest(CoordLimit limit) : limit_(limit) {}

  /// A session without a view. Sessions are named once.
  void open(SessionId session);
  /// Forgets the session; unknown ones are allowed.
  void close(SessionId session);
  /// Null for an unknown session.
  const SessionInterest* find(SessionId session) const;

  /// The calls below require an open session.
  /// Returns how many chunks came into the view.
  std::size_t set_view(SessionId session, const View& view);
  /// The peer has looked elsewhere in between: chunks that are not in all of `passed` (without any: all
  /// chunks) are wanted again.
  void want_again(SessionId session, std::span<const View> passed);
  std::optional<ChunkKey> nearest_wanted(SessionId session);
  std::optional<ChunkKey> next_for_audit(SessionId session);
  /// Moves a chunk of the session's view to a state; returns false if the view does not hold it.
  bool set_state(SessionId session, const ChunkKey& key, ChunkInterest state);

  /// Ascending. The span lives until the next change.
  std::span<const SessionId> subscribers(const ChunkKey& key) const;
  /// Copies, because the caller answers each of them by changing its state.
  std::vector<SessionId> waiting(const ChunkKey& key) const;
  bool subscribes(SessionId session, const ChunkKey& key) const;
  /// Whether any session is subscribed to the chunk or waits for it.
  bool is_used(const ChunkKey& key) const { return users_.contains(key); }
  /// Chunks that lost their last user since the last call (some may have won a new one).
  std::vector<ChunkKey> take_released() { return std::exchange(released_, {}); }

 private:
  struct Users {
    std::vector<SessionId>
        subscribers;  // ascending, so that those of many chunks are joined in one pass
    std::vector<SessionId> waiting;  // in the order in which they came
  };
  void leave(SessionId session, const ChunkKey& key, ChunkInterest was);
  void enter(SessionId session, const ChunkKey& key, ChunkInterest now);
  SessionInterest& at(SessionId session);

  CoordLimit limit_;
  std::map<SessionId, SessionInterest> sessions_;
  std::unordered_map<ChunkKey, Users, ChunkKeyHash> users_;  // never empty entries
  std::vector<ChunkKey> released_;
};

}  // namespace runstone
