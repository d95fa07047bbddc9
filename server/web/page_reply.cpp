#include "server/web/page_reply.hpp"

namespace runstone {

std::string PageReply::value(std::string_view name) const {
  for (const std::string& line : lines) {
    if (line.size() > name.size() && line.starts_with(name) && line[name.size()] == ' ')
      return line.substr(name.size() + 1);
  }
  return "";
}

bool is_whole_page_reply(std::string_view text) {
  if (!text.ends_with('\n')) return false;
  text.remove_suffix(1);
  const std::size_t before = text.rfind('\n');
  return text.substr(before == std::string_view::npos ? 0 : before + 1).starts_with('=');
}

PageReply parse_page_reply(std::string_view text) {
  PageReply out;
  out.end = PageReply::End::late;
  bool is_first = true;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) break;  // half a line
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (line == "=ok") out.end = PageReply::End::ok;
    if (line == "=error") out.end = PageReply::End::refused;
    if (line == "=unsaved") out.end = PageReply::End::unsaved;
    if (!line.starts_with('|')) continue;
    const std::string_view said = line.substr(1);
    if (!is_first) {
      out.lines.emplace_back(said);
      continue;
    }
    is_first = false;
    if (said == "!known") out.kind = PageReply::Kind::known;
    if (said == "!unknown") out.kind = PageReply::Kind::unknown;
    if (said == "!barred") out.kind = PageReply::Kind::barred;
  }
  return out;
}

}  // namespace runstone
