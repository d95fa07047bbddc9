// ChatEntry: a line of the chat as the log of the chat keeps it.
#pragma once
#include "common/core/public_key.hpp"
#include "protocol/codec/chat_messages.hpp"

namespace runstone {

struct ChatEntry {
  /// The line of a player or of the host. The log does not keep the author number: the number of a
  /// player who never edits may be given to another player after a restart.
  ChatLine line;
  PublicKey key{};            // of the player who wrote it; zeros: the console wrote it
  bool is_withdrawn = false;  // players do not get it any more
  friend bool operator==(const ChatEntry&, const ChatEntry&) = default;
};

}  // namespace runstone
