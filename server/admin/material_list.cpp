#include "server/admin/material_list.hpp"

#include <cstddef>

namespace runstone {
namespace {

constexpr std::size_t kNamesListed = 1000;

}  // namespace

std::string material_list(const MaterialTable& materials, std::string_view part) {
  std::string text;
  std::size_t matches = 0;
  for (const MaterialInfo& material : materials.rows()) {
    if (material.name.find(part) == std::string::npos) continue;
    if (++matches <= kNamesListed) text += material.name + "\n";
  }
  if (matches == 0) return "no material's name contains \"" + std::string(part) + "\"";
  if (matches > kNamesListed) {
    text += "and " + std::to_string(matches - kNamesListed) + " more: materials PART\n";
  }
  text.pop_back();
  return text;
}

}  // namespace runstone
