// Ground surface: the height of the ground in each column of a box. Ground is what a landscape is
// made of. Air, liquids, plants and trees stand on it or lie above it.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"
#include "common/sculpt/ground_columns.hpp"

namespace runstone {

/// The parts that materials have in a landscape, by id. Ids beyond the end are ground, except air.
class GroundMaterials {
 public:
  /// Ground is each opaque, solid cube, except wood and leaves: materials in whose names one of the
  /// words log, wood, trunk, tree, leaves, needles or bark stands between other characters than
  /// letters. Cost: O(bytes of the names).
  static GroundMaterials of(const MaterialTable& table);

  bool is_ground(Material material) const {
    return material != kEmpty && (material >= parts_.size() || parts_[material] == Part::ground);
  }
  bool is_liquid(Material material) const {
    return material < parts_.size() && parts_[material] == Part::liquid;
  }
  /// Returns true for air and liquids, which ground may replace.
  bool is_open(Material material) const { return material == kEmpty || is_liquid(material); }

 private:
  enum class Part : std::uint8_t { other, ground, liquid };
  std::vector<Part> parts_;
};

/// The height of a column without a surface.
inline constexpr std::int32_t kNoSurface = std::numeric_limits<std::int32_t>::min();

/// Returns the height of the highest ground voxel of each column of the box, by
/// GroundColumns::index(). A column has kNoSurface if it is not known, if it has no ground, or if
/// ground reaches the top of the box, above which the surface would be. Cost: O(runs).
std::vector<std::int32_t> surface_heights(const GroundColumns& columns,
                                          const GroundMaterials& materials);

}  // namespace runstone
