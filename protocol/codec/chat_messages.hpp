// Chat messages: what players write to each other, and what the server writes to them. The chat is
// no part of the world: it is in no edit log, and nothing depends on it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

/// One line for everybody.
struct ChatRequest {
  std::string text;  // 1 .. kChatBytesMax bytes
  friend bool operator==(const ChatRequest&, const ChatRequest&) = default;
};

/// Who wrote a line. Values are on the wire and in the log of the chat. Readers accept values that
/// they do not know.
enum class ChatLineKind : std::uint8_t {
  player = 1,
  server = 2,              // the host, by the command `say`
  message_of_the_day = 3,  // for one who joins
  refused = 4,             // for the sender alone: why a line was not passed on
  visit = 5,               // a player has joined or left
};

struct ChatLine {
  ChatLineKind kind = ChatLineKind::player;
  AuthorId author = 0;  // of ChatLineKind::player, 0 if it is not known any more; otherwise 0
  std::string name;     // of ChatLineKind::player: 1 .. kPlayerNameBytesMax bytes; otherwise empty
  std::string text;     // 1 .. kChatBytesMax bytes
  TimeUs utc_us = 0;    // when the server took the line
  friend bool operator==(const ChatLine&, const ChatLine&) = default;
};

struct ChatLines {
  std::vector<ChatLine> lines;  // 1 .. kChatLinesMax, in their order
  friend bool operator==(const ChatLines&, const ChatLines&) = default;
};

/// Identifies a line of a player. Author numbers cannot identify it, because a restarted server
/// gives other numbers.
struct ChatLineId {
  TimeUs utc_us = 0;  // of the line
  std::string name;   // of the line; empty: of no player's line
  friend bool operator==(const ChatLineId&, const ChatLineId&) = default;
};
/// Returns the id of the line.
inline ChatLineId id_of(const ChatLine& line) { return {line.utc_us, line.name}; }

/// Lines that clients hide from now on.
struct ChatWithdrawn {
  std::vector<ChatLineId> lines;  // 1 .. kChatWithdrawnMax
  friend bool operator==(const ChatWithdrawn&, const ChatWithdrawn&) = default;
};

}  // namespace runstone
