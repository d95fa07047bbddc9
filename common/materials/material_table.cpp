#include "common/materials/material_table.hpp"

#include <cmath>
#include <functional>
#include <utility>

#include "common/core/text.hpp"

namespace runstone {
namespace {

const char* broken_rule(const SurfaceRule& rule) {
  constexpr double kReach = 10000;
  // The conditions are written so that a NaN fails.
  if (!(std::fabs(rule.elevation) <= kReach)) return "elevation must be within -10000 .. 10000";
  if (!(std::fabs(rule.distance) <= kReach)) return "distance must be within -10000 .. 10000";
  if (!(rule.frequency > 0 && rule.frequency <= 1))
    return "frequency must be above 0 and at most 1";
  return nullptr;
}

}  // namespace

MaterialTable::MaterialTable() {
  rows_.push_back({"air", {0, 0, 0, 0}, Visibility::empty, std::nullopt});
  ids_.emplace("air", kEmpty);
}

std::optional<Material> MaterialTable::find(std::string_view name) const {
  const auto found = ids_.find(name);
  if (found == ids_.end()) return std::nullopt;
  return found->second;
}

Result<Material> MaterialTable::add(MaterialInfo info) {
  if (rows_.size() >= kMaterialCountMax)
    return fail(ErrorCode::limit_exceeded, "more than 65536 materials");
  if (info.name.empty() || info.name.size() > kMaterialNameBytesMax ||
      !is_printable_utf8(info.name)) {
    return fail(ErrorCode::bad_value,
                "name must be 1 .. 64 bytes of UTF-8 without control characters");
  }
  if (info.visibility == Visibility::opaque && info.colour[3] != 255) {
    return fail(ErrorCode::bad_value, "colour of an opaque material must not be see-through");
  }
  if (info.generation) {
    if (const char* what = broken_rule(info.generation->surface))
      return fail(ErrorCode::bad_value, what);
    if (info.generation->reversed) {
      if (const char* what = broken_rule(*info.generation->reversed))
        return fail(ErrorCode::bad_value, what);
    }
  }
  const auto id = static_cast<Material>(rows_.size());
  if (!ids_.emplace(info.name, id).second)
    return fail(ErrorCode::bad_value, "name is already taken");
  rows_.push_back(std::move(info));
  return id;
}

std::vector<Visibility> visibilities(const MaterialTable& table) {
  std::vector<Visibility> out;
  out.reserve(table.size());
  for (const MaterialInfo& row : table.rows()) out.push_back(row.visibility);
  return out;
}

}  // namespace runstone
