#include "server/web/origin_check.hpp"

#include <algorithm>
#include <cctype>

namespace runstone {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_origin(std::string_view text) {
  std::string_view host = text;
  if (host.starts_with("https://")) {
    host.remove_prefix(8);
  } else if (host.starts_with("http://")) {
    host.remove_prefix(7);
  } else {
    return false;
  }
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789.-:[]";
  return !host.empty() && host.find_first_not_of(kAllowed) == std::string_view::npos;
}

/// Returns true for "localhost" and for addresses in digits, with or without a port.
bool is_no_name(std::string_view host) {
  if (host.starts_with('[')) return true;
  const std::string_view name = host.substr(0, host.find(':'));
  return name == "localhost" || name.find_first_not_of("0123456789.") == std::string_view::npos;
}

}  // namespace

Result<std::vector<std::string>, std::string> parse_origins(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = std::min(text.find_first_not_of(" ,", at), text.size());
    const std::size_t end = std::min(text.find_first_of(" ,", begin), text.size());
    at = end;
    if (begin == end) break;
    out.push_back(text.substr(begin, end - begin));
    if (!is_origin(out.back()))
      return failure("origins: \"" + out.back() +
                     "\" is no origin such as https://play.example.org");
  }
  return out;
}

bool OriginCheck::allows(std::optional<std::string_view> origin, std::string_view host) const {
  if (!origin) return true;
  const std::string asked = lower(*origin);
  if (allowed_.empty()) {
    const std::string own = lower(host);
    return !own.empty() && asked == scheme_ + own && (is_encrypted_ || is_no_name(own));
  }
  return std::find(allowed_.begin(), allowed_.end(), asked) != allowed_.end();
}

std::string OriginCheck::sockets() const {
  constexpr std::string_view kHttp = "http";
  std::string out;
  for (const std::string& origin : allowed_) out += " ws" + origin.substr(kHttp.size());
  return out;
}

}  // namespace runstone
