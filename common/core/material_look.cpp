#include "common/core/material_look.hpp"

#include <algorithm>

namespace runstone {

Result<void> validate_look(const MaterialLook& look) {
  if (std::max({look.variation, look.grain, look.roughness, look.emission}) > kLookShareMax)
    return fail(ErrorCode::bad_value, "a share of the look exceeds 100");
  if (static_cast<std::uint8_t>(look.pattern) >= kMaterialPatterns)
    return fail(ErrorCode::bad_value, "pattern of the look is unknown");
  return {};
}

MaterialLook nearest_valid_look(MaterialLook look) {
  for (std::uint8_t* share : {&look.variation, &look.grain, &look.roughness, &look.emission})
    *share = std::min(*share, kLookShareMax);
  if (static_cast<std::uint8_t>(look.pattern) >= kMaterialPatterns)
    look.pattern = MaterialPattern::none;
  return look;
}

}  // namespace runstone
