#include "common/materials/material_lookup.hpp"

#include <cstddef>
#include <optional>

namespace runstone {
namespace {

constexpr std::size_t kNamesListed = 8;

/// Returns true if `full` is a prefix of at least one byte, a colon and `name`.
bool ends_with_part(std::string_view full, std::string_view name) {
  return full.size() > name.size() + 1 && full.ends_with(name) &&
         full[full.size() - name.size() - 1] == ':';
}

}  // namespace

Result<Material, std::string> find_material(const MaterialTable& table, std::string_view name) {
  if (const auto exact = table.find(name)) return *exact;
  const std::string quoted = "\"" + std::string(name) + "\"";
  std::optional<Material> found;
  std::string names;
  std::size_t matches = 0;
  for (std::size_t id = 0; !name.empty() && id < table.size(); ++id) {
    const std::string& full = table.rows()[id].name;
    if (!ends_with_part(full, name)) continue;
    found = static_cast<Material>(id);
    ++matches;
    if (matches <= kNamesListed) names += (matches == 1 ? "" : ", ") + full;
  }
  if (matches == 1) return *found;
  if (matches == 0) return failure("the world has no material " + quoted);
  if (matches > kNamesListed) names += ", …";
  return failure(quoted + " is ambiguous: " + names);
}

}  // namespace runstone
