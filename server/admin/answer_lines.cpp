#include "server/admin/answer_lines.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {

std::vector<std::string> answer_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view rest = std::string_view(text).substr(at, end - at);
    do {
      const std::string_view line = cut_utf8(rest, kCommandLineBytesMax);
      lines.emplace_back(line);
      rest.remove_prefix(line.size());
    } while (!rest.empty());
    at = end + 1;
  }
  return lines;
}

}  // namespace runstone
