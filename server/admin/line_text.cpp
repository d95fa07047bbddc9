#include "server/admin/line_text.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "protocol/rules/chat_text.hpp"

namespace runstone {

Result<std::string, std::string> line_text(const WordReader& reader) {
  std::string_view rest = reader.text();
  const std::size_t last = rest.find_last_not_of(' ');
  rest = rest.substr(0, last == std::string_view::npos ? 0 : last + 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  const bool is_quoted =
      rest.size() >= 2 && rest.front() == '"' && rest.find('"', 1) == rest.size() - 1;
  if (is_quoted) rest = rest.substr(1, rest.size() - 2);
  auto text = chat_text(rest);
  if (!text) return failure(reader.command() + ": the text is refused: " + text.error());
  return *std::move(text);
}

}  // namespace runstone
