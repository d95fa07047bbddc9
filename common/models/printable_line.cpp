#include "common/models/printable_line.hpp"

#include <algorithm>

#include "common/core/text.hpp"

namespace runstone {

std::string printable_line(std::string_view text, std::size_t bytes_max) {
  constexpr std::size_t kCharacterBytesMax = 4;
  // The bytes behind these cannot be part of the result, because each byte stays or becomes one
  // byte.
  text = text.substr(0, std::min(text.size(), bytes_max + kCharacterBytesMax));
  std::string line;
  while (!text.empty()) {
    std::size_t bytes = 1;
    while (bytes <= std::min(kCharacterBytesMax, text.size()) &&
           !is_printable_utf8(text.substr(0, bytes)))
      ++bytes;
    const bool is_character = bytes <= std::min(kCharacterBytesMax, text.size());
    if (!is_character) bytes = 1;
    if (line.size() + bytes > bytes_max) break;
    if (is_character) {
      line.append(text.substr(0, bytes));
    } else {
      line.push_back('?');
    }
    text.remove_prefix(bytes);
  }
  return line;
}

}  // namespace runstone
