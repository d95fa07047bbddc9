#include "server/chat/chat_query.hpp"

#include <algorithm>

#include "common/core/hex.hpp"
#include "common/names/folded_name.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

/// Compares in upper case. Fingerprints and keys have ASCII characters only.
bool is_same_key_text(const std::string& a, const std::string& b) {
  const auto upper = [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return upper(x) == upper(y); });
}

}  // namespace

bool is_written_by(const ChatEntry& entry, const std::string& by) {
  if (by.empty()) return true;
  if (entry.line.kind == ChatLineKind::server) return folded_name(by) == "server";
  return folded_name(entry.line.name) == folded_name(by) ||
         is_same_key_text(key_fingerprint(entry.key), by) ||
         is_same_key_text(to_hex(entry.key), by);
}

}  // namespace runstone
