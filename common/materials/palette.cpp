#include "common/materials/palette.hpp"

#include <utility>

#include "common/materials/material_lookup.hpp"

namespace runstone {

Result<std::size_t> append_palette(MaterialTable& table, const MaterialTable& palette) {
  MaterialTable whole = table;
  for (const MaterialInfo& info : palette.rows()) {
    if (find_material(table, info.name)) continue;
    if (const auto added = whole.add(info); !added) return failure(added.error());
  }
  const std::size_t count = whole.size() - table.size();
  table = std::move(whole);
  return count;
}

}  // namespace runstone
