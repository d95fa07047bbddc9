#include "server/admin/name_list.hpp"

#include <cstddef>

#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {

std::string name_list(const std::vector<OwnedName>& owned) {
  constexpr std::size_t kListed = 500;
  if (owned.empty()) return "nobody owns a name";
  std::string text;
  for (std::size_t i = 0; i < owned.size() && i < kListed; ++i) {
    const OwnedName& name = owned[i];
    text += "\"" + name.name + "\" " + key_fingerprint(name.key);
    if (name.author) text += " #" + std::to_string(*name.author);
    text += "\n";
  }
  if (owned.size() > kListed) text += "and " + std::to_string(owned.size() - kListed) + " more\n";
  text.pop_back();
  return text;
}

}  // namespace runstone
