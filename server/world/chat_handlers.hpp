// Chat handlers: what players and the host write to everybody. The lines of a tick are one message,
// which is encoded once. A session whose queue is full misses the message.
#pragma once
#include <cstddef>
#include <string>

#include "common/core/public_key.hpp"
#include "server/world/clocks.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// The same player may not write the same line again within this time.
inline constexpr TimeUs kChatRepeatUs = 10'000'000;

/// Queues the line for everybody, or answers with the reason why it is not passed on. A session gets
/// few such answers a second. Each refused line counts as more bytes read than it has.
void on_chat(WorldState& world, SessionId session, const ChatRequest& request, const Clocks& now);

/// Queues a line of the host. `by` is the key of the player who gave the command; zeros: the console.
/// Returns the number of sessions that get the line. Requires a text that chat_text() returned.
std::size_t say(WorldState& world, const std::string& text, const PublicKey& by, const Clocks& now);

/// Sends one session a line of the host, which nobody else gets and no log keeps. It is skipped if
/// the session reads no chat or has no room. Requires a text that chat_text() returned.
void tell(WorldState& world, SessionId session, const std::string& text, const Clocks& now);

/// Sends a session that has opened the newest lines, and then the message of the day.
void send_recent_chat(WorldState& world, SessionId session, const Clocks& now);

/// Sends the lines that wait to every session. Call it on every tick.
void broadcast_chat(WorldState& world);

}  // namespace runstone
