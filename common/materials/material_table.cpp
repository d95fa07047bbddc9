#include "common/materials/material_table.hpp"

#include <cmath>
#include <functional>
#include <utility>

namespace runstone {
namespace {

/// Well-formed UTF-8 (Unicode 15, table 3-7) without C0 controls and DEL, so that a name is safe in a log
/// line and in a TOML basic string.
bool is_printable_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead < 0x20 || lead == 0x7f) return false;
    std::size_t length = 1;
    unsigned low = 0x80, high = 0xbf;  // bounds of the second byte: shut out overlong forms and surrogates
    if (lead >= 0x80) {
      if (lead >= 0xc2 && lead <= 0xdf) {
        length = 2;
      } else if (lead >= 0xe0 && lead <= 0xef) {
        length = 3;
        if (lead == 0xe0) low = 0xa0;
        if (lead == 0xed) high = 0x9f;
      } else if (lead >= 0xf0 && lead <= 0xf4) {
        length = 4;
        if (lead == 0xf0) low = 0x90;
        if (lead == 0xf4) high = 0x8f;
      } else {
        return false;
      }
    }
    if (text.size() - i < length) return false;
    for (std::size_t k = 1; k < length; ++k) {
      const auto byte = static_cast<unsigned char>(text[i + k]);
      if (byte < low || byte > high) return false;
      low = 0x80;
      high = 0xbf;
    }
    i += length;
  }
  return true;
}

const char* broken_rule(const SurfaceRule& rule) {
  constexpr double kReach = 10000;
  // Written so that a NaN fails.
  if (!(std::fabs(rule.elevation) <= kReach)) return "elevation must be within -10000 .. 10000";
  if (!(std::fabs(rule.distance) <= kReach)) return "distance must be within -10000 .. 10000";
  if (!(rule.frequency > 0 && rule.frequency <= 1)) return "frequency must be above 0 and at most 1";
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
  if (rows_.size() >= kMaterialCountMax) return fail(ErrorCode::limit_exceeded, "more than 65536 materials");
  if (info.name.empty() || info.name.size() > kMaterialNameBytesMax || !is_printable_utf8(info.name)) {
    return fail(ErrorCode::bad_value, "name must be 1 .. 64 bytes of UTF-8 without control characters");
  }
  if (info.visibility == Visibility::opaque && info.colour[3] != 255) {
    return fail(ErrorCode::bad_value, "colour of an opaque material must not be see-through");
  }
  if (info.generation) {
    if (const char* what = broken_rule(info.generation->surface)) return fail(ErrorCode::bad_value, what);
    if (info.generation->reversed) {
      if (const char* what = broken_rule(*info.generation->reversed)) return fail(ErrorCode::bad_value, what);
    }
  }
  const auto id = static_cast<Material>(rows_.size());
  if (!ids_.emplace(info.name, id).second) return fail(ErrorCode::bad_value, "name is already taken");
  rows_.push_back(std::move(info));
  return id;
}

}  // namespace runstone
