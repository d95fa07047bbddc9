// ChatRoom: what players and the host write to everybody. The lines of a tick are one message,
// which is encoded once. A session whose queue is full misses the message.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "common/core/token_bucket.hpp"
#include "server/world/people/chat_state.hpp"
#include "server/world/rights/rights.hpp"

namespace runstone {

/// A player may not write the same line again within this time.
inline constexpr TimeUs kChatRepeatUs = 10'000'000;
/// A session gets so many lines that say why its own lines are not passed on.
inline constexpr std::uint64_t kChatAnswersPerSecond = 1, kChatAnswerBurst = 3;

class ChatRoom {
 public:
  ChatRoom(const WorldConfig& config, const WorldStart& start, WorldEnvironment& environment,
           Sessions& sessions, Order& order, Rights& rights);

  /// Queues the line for everybody, or answers with the reason why it is not passed on. A session
  /// gets few such answers a second. Each refused line counts as more bytes read than it has.
  void on_line(Session& session, const ChatRequest& request, const Clocks& now);
  /// Queues a line of the host. `by` is the key of the player who gave the command; zeros: the
  /// console. Returns the number of sessions that get the line. Requires a text that chat_text()
  /// returned.
  std::size_t say(const std::string& text, const PublicKey& by, const Clocks& now);
  /// Sends one session a line of the host, which nobody else gets and no log keeps. It is skipped
  /// if the session reads no chat or has no room. Requires a text that chat_text() returned.
  void tell(const Session& session, const std::string& text, const Clocks& now);
  /// Sends a line of the host, as tell(), to each open session whose player is meant. Returns their
  /// number. Cost: O(sessions).
  std::size_t tell_those(const std::function<bool(const PublicKey&)>& is_meant,
                         const std::string& text, const Clocks& now);
  /// Sends every session a line about a player who has joined or left, but not to the player. No
  /// log keeps it. Sessions without the feature visits do not get it.
  void tell_of_visit(const PublicKey& player, const std::string& text, const Clocks& now);
  /// Sends a session that has opened the newest lines, and then the message of the day.
  void send_recent(const Session& session, const Clocks& now);
  /// Withdraws the lines of a player that are among the kChatKeptMax newest lines of all players,
  /// and the lines that wait. Clients hide them, players who join later do not get them, and the
  /// log keeps them. Returns their number. Cost: O(kChatKeptMax + kChatLinesMax + sessions).
  std::size_t withdraw(const PublicKey& key);
  /// Sends the lines that wait to every session. Call it on every tick.
  void broadcast();
  void forget(SessionId session) { answers_.erase(session); }

 private:
  /// Why a line is not passed on.
  struct Refusal {
    std::string text;  // for the player
    std::string what;  // for moderators: without numbers that differ each time
  };
  TimeUs time_of_line(const Clocks& now);
  TimeUs repeat_wait_us(AuthorId author, const std::string& text, TimeUs now_us) const;
  std::optional<Refusal> pay(const Session& session, TimeUs now_us);
  void refuse(Session& session, const Refusal& refusal, const Clocks& now);
  void add(ChatLine line, const PublicKey& by);

  const WorldConfig& config_;
  WorldEnvironment& environment_;
  Sessions& sessions_;
  Order& order_;
  Rights& rights_;
  ChatState state_;
  std::map<SessionId, TokenBucket> answers_;  // of the sessions whose lines were refused
};

}  // namespace runstone
