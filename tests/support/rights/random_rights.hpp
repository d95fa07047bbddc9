// Seeded changes of rights for property tests.
#pragma once
#include "common/core/hash.hpp"
#include "common/rights/rights_change.hpp"

namespace runstone::test {

/// Returns a key for each number.
inline PublicKey key_of(std::uint8_t number) {
  PublicKey key{};
  key[0] = number;
  return key;
}

/// Returns a box within `world` with sides of at most `side_max`.
VoxelBox random_box_in(SplitMix64& rng, const VoxelBox& world, std::int32_t side_max);

/// Draws any valid change. Small and large numbers are equally frequent.
RightsChange random_rights_change(SplitMix64& rng);

/// Draws a valid change among few keys (key_of(0) .. key_of(kCloseKeys - 1)), roles, boxes and
/// addresses, so that later changes replace what earlier ones have set. Boxes lie in kCloseWorld.
RightsChange random_close_change(SplitMix64& rng);
inline constexpr std::uint8_t kCloseKeys = 6;
inline constexpr VoxelBox kCloseWorld = {{-6, -6, -6}, {6, 6, 6}};
std::string random_close_role(SplitMix64& rng);
ProtectedBox random_close_box(SplitMix64& rng);

}  // namespace runstone::test
