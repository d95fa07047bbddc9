// MaterialLook: how the faces of a material are drawn, besides its colour. All values are integers,
// so that tables, records and messages hold the same values.
#pragma once
#include <compare>
#include <cstdint>

#include "common/core/result.hpp"

namespace runstone {

/// The pattern on each face of a voxel. Values are frozen: tables, records and messages hold them.
enum class MaterialPattern : std::uint8_t {
  none = 0,
  planks = 1,  // four boards, with dark joints
  bricks = 2,  // four rows of bricks, each shifted by half a brick
  tiles = 3,   // one slab with a dark joint around it
  cobble = 4,  // rounded stones of different brightness
  bark = 5,    // grooves along the vertical axis, rings on the upper and lower face
  weave = 6,   // threads that cross
  // Silhouettes of plants. They are drawn on the planes of plants; other faces have no pattern.
  blades = 7,   // blades of grass
  flower = 8,   // a blossom in the colour of the material, on a green stalk with leaves
  foliage = 9,  // a ragged bush
};
/// The number of patterns. A greater or equal value is a pattern of a later version and is drawn as
/// `none`.
inline constexpr std::uint8_t kMaterialPatterns = 10;

/// The greatest value of a share, in percent.
inline constexpr std::uint8_t kLookShareMax = 100;

struct MaterialLook {
  std::uint8_t variation = 10;   // of the brightness from voxel to voxel, percent
  std::uint8_t grain = 8;        // of the brightness within a voxel, percent
  std::uint8_t roughness = 100;  // 100: matt; 0: mirrors the sun in a small spot. Percent
  std::uint8_t emission = 0;     // light that the material gives off in its colour, percent
  MaterialPattern pattern = MaterialPattern::none;
  friend auto operator<=>(const MaterialLook&, const MaterialLook&) = default;
};

/// Fails (bad_value) for a share above kLookShareMax and for a pattern of a later version.
Result<void> validate_look(const MaterialLook& look);

/// Returns the nearest look that validate_look() accepts: a share above kLookShareMax becomes
/// kLookShareMax, and a pattern of a later version becomes `none`.
MaterialLook nearest_valid_look(MaterialLook look);

}  // namespace runstone
