#include "client/play/named_hotbars.hpp"

#include <algorithm>

#include "common/core/text.hpp"

namespace runstone {
namespace {

std::string unknown(const std::string& name) { return "no hotbar has the name \"" + name + "\""; }

}  // namespace

Result<void, std::string> NamedHotbars::keep(const std::string& name, const Slots& slots,
                                             const MaterialTable& materials) {
  if (name.empty() || name.size() > kNameBytesMax || !is_printable_utf8(name))
    return failure("the name of a hotbar has 1 to " + std::to_string(kNameBytesMax) + " bytes");
  if (!lists_.contains(name) && lists_.size() >= kCountMax)
    return failure("you have " + std::to_string(kCountMax) + " hotbars: forget one first");
  std::vector<std::string>& list = lists_[name];
  list.clear();
  for (const Material material : slots)
    list.push_back(material == kEmpty ? std::string() : materials[material].name);
  is_changed_ = true;
  return {};
}

Result<NamedHotbars::Slots, std::string> NamedHotbars::take(const std::string& name,
                                                            const MaterialTable& materials) const {
  const auto found = lists_.find(name);
  if (found == lists_.end()) return failure(unknown(name));
  Slots out{};
  for (std::size_t i = 0; i < std::min(out.size(), found->second.size()); ++i)
    out[i] = materials.find(found->second[i]).value_or(kEmpty);
  return out;
}

Result<void, std::string> NamedHotbars::forget(const std::string& name) {
  if (lists_.erase(name) == 0) return failure(unknown(name));
  is_changed_ = true;
  return {};
}

}  // namespace runstone
