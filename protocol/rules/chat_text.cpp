#include "protocol/rules/chat_text.hpp"

#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

std::string_view trimmed(std::string_view line) {
  const std::size_t first = line.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(' ') + 1 - first);
}

}  // namespace

Result<std::string, std::string> chat_text(std::string_view line) {
  const std::string_view text = trimmed(line);
  if (text.empty()) return failure("it is empty");
  if (text.size() > kChatBytesMax)
    return failure("it has more than " + std::to_string(kChatBytesMax) + " bytes");
  if (!is_printable_utf8(text)) return failure("it has control characters, or is no UTF-8 text");
  if (has_unseen_character(text)) return failure("it has invisible characters");
  return std::string(text);
}

}  // namespace runstone
