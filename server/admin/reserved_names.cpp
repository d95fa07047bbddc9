#include "server/admin/reserved_names.hpp"

#include <algorithm>

#include "common/core/text.hpp"
#include "common/names/folded_name.hpp"

namespace runstone {

Result<std::vector<std::string>, std::string> parse_reserved_names(std::string_view text) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    std::string_view name = text.substr(at, end - at);
    at = end + 1;
    while (name.starts_with(' ')) name.remove_prefix(1);
    while (name.ends_with(' ')) name.remove_suffix(1);
    if (name.empty()) continue;
    if (!is_plain_name(name)) {
      return failure("a reserved name has no quotes, backslashes or invisible characters");
    }
    names.emplace_back(name);
  }
  return names;
}

std::set<std::string> folded_reserved_names(const std::vector<std::string>& more) {
  std::set<std::string> folded;
  for (const char* name : kReservedNames) folded.insert(folded_name(name));
  for (const std::string& name : more) folded.insert(folded_name(name));
  return folded;
}

}  // namespace runstone
