// Random looks of materials for tests.
#pragma once
#include <cstdint>

#include "common/core/hash.hpp"
#include "common/core/material_look.hpp"

namespace runstone::test {

/// Returns a valid look.
inline MaterialLook random_look(SplitMix64& rng) {
  const auto share = [&] { return static_cast<std::uint8_t>(rng.below(kLookShareMax + 1U)); };
  MaterialLook look;
  look.variation = share();
  look.grain = share();
  look.roughness = share();
  look.emission = share();
  look.pattern = static_cast<MaterialPattern>(rng.below(kMaterialPatterns));
  return look;
}

}  // namespace runstone::test
