#include "server/admin/chat_list.hpp"

#include "common/core/utc_text.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {

std::string chat_list(const std::vector<ChatEntry>& entries) {
  if (entries.empty()) return "the log of the chat has no such lines";
  std::string text;
  for (const ChatEntry& entry : entries) {
    const bool is_of_server = entry.line.kind == ChatLineKind::server;
    if (!text.empty()) text += "\n";
    text += utc_text(entry.line.utc_us) + " " + (is_of_server ? "server" : entry.line.name);
    if (entry.key != PublicKey{}) text += " " + key_fingerprint(entry.key);
    text += ": " + entry.line.text;
  }
  return text;
}

}  // namespace runstone
