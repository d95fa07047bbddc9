#include "common/materials/look_on_shape.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

bool has_silhouette(const std::optional<MaterialLook>& look) {
  return look && is_silhouette(look->pattern);
}

}  // namespace

bool is_silhouette(MaterialPattern pattern) {
  return pattern >= MaterialPattern::blades && pattern <= MaterialPattern::foliage;
}

MaterialLook look_on_shape(MaterialLook look, const Shape& shape) {
  if (is_silhouette(look.pattern) && shape.form != ShapeForm::crossed)
    look.pattern = MaterialPattern::none;
  return look;
}

MaterialRow with_look_on_shape(MaterialRow row) {
  if (row.look) row.look = look_on_shape(*row.look, row.shape);
  return row;
}

MaterialTable with_looks_on_shapes(const MaterialTable& table) {
  MaterialTable out;
  for (MaterialInfo info : table.rows().subspan(out.size())) {
    if (info.look) info.look = look_on_shape(*info.look, info.shape);
    const auto added = out.add(std::move(info));
    RUNSTONE_ASSERT(added.has_value());
  }
  return out;
}

bool has_silhouettes(std::span<const MaterialRow> rows) {
  return std::any_of(rows.begin(), rows.end(),
                     [](const MaterialRow& row) { return has_silhouette(row.look); });
}

bool has_silhouettes(const MaterialTable& table) {
  const auto rows = table.rows();
  return std::any_of(rows.begin(), rows.end(),
                     [](const MaterialInfo& row) { return has_silhouette(row.look); });
}

}  // namespace runstone
