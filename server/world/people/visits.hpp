// Visits: the lines of the chat that say who has joined and who has left. A player is here as long
// as at least one session of the key is open.
//   - A player who comes back within kVisitPauseUs has not left: there is no line. So the line
//     about one who leaves comes that much later.
//   - A player who changes the server, or whose server begins to follow another owner, has neither
//     joined nor left.
//   - All lines together are at most kVisitLinesPerSecond, with kVisitLineBurst at once. Further
//     lines are dropped. The list of players (PlayerList) is always complete.
// The lines are in no log, and players who join later do not get them. Thread: the world strand.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/core/token_bucket.hpp"
#include "server/world/people/chat_room.hpp"

namespace runstone {

inline constexpr TimeUs kVisitPauseUs = 10'000'000;
inline constexpr std::uint64_t kVisitLinesPerSecond = 1, kVisitLineBurst = 8;

class Visits {
 public:
  /// Both must outlive the object.
  Visits(const Sessions& sessions, ChatRoom& chat) : sessions_(sessions), chat_(chat) {}

  /// Reports an open session. `goes_on`: the player was here before, at this or at another server.
  void joined(const Session& session, bool goes_on, const Clocks& now);
  /// Reports that an open session has ended. The next tick() notes the time.
  void left(const Session& session);
  /// Returns true if a session of the key is open. Cost: O(log players).
  bool is_here(const PublicKey& key) const {
    const auto found = visitors_.find(key);
    return found != visitors_.end() && found->second.sessions > 0;
  }
  /// Says who has left. Call it on every tick of a server that owns the world.
  void tick(const Clocks& now);
  /// Forgets everybody, and takes the players with open sessions for those who are here.
  void begin_anew();

 private:
  struct Visitor {
    std::string name;
    std::size_t sessions = 0;
    std::optional<TimeUs> gone_us;  // when tick() noticed that no session is left
  };
  void say(const PublicKey& key, const std::string& line, const Clocks& now);

  const Sessions& sessions_;
  ChatRoom& chat_;
  std::map<PublicKey, Visitor> visitors_;
  std::size_t gone_ = 0;  // visitors without a session
  TokenBucket lines_{kVisitLinesPerSecond, kVisitLineBurst};
};

}  // namespace runstone
