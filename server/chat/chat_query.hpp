// ChatQuery: selects lines of the log of the chat.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/ids.hpp"
#include "server/world/environment/chat_entry.hpp"

namespace runstone {

inline constexpr std::uint64_t kChatLinesListedMax = 1'000;

struct ChatQuery {
  /// The name that a player had, the player's fingerprint, or the key in hexadecimal digits;
  /// `server` for the host. Names are compared by their folded forms. Empty: everybody.
  std::string by;
  std::optional<TimeUs> since_us;  // UTC
  std::uint64_t limit = 20;        // newest lines, 1 .. kChatLinesListedMax
  bool with_withdrawn = true;      // also lines that were withdrawn
  friend bool operator==(const ChatQuery&, const ChatQuery&) = default;
};

/// Returns true if the entry is one of the player whom `by` means.
bool is_written_by(const ChatEntry& entry, const std::string& by);

}  // namespace runstone
