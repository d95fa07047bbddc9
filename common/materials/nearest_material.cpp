#include "common/materials/nearest_material.hpp"

#include <cstdint>
#include <limits>

namespace runstone {
namespace {

/// Returns a distance that weighs the parts of a colour by how the eye sees them: the "redmean"
/// approximation of T. Riemersma (CompuPhase).
std::int64_t colour_distance(const MaterialColour& a, const MaterialColour& b) {
  const int red_mean = (a[0] + b[0]) / 2;
  const std::int64_t red = a[0] - b[0], green = a[1] - b[1], blue = a[2] - b[2];
  const std::int64_t alpha = a[3] - b[3];
  return (512 + red_mean) * red * red + 1024 * green * green + (767 - red_mean) * blue * blue +
         512 * alpha * alpha;
}

}  // namespace

Material nearest_material(const MaterialRow& row, const MaterialTable& table) {
  Material nearest = kEmpty;
  bool has_same = false;
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::size_t id = 1; id < table.size(); ++id) {
    const MaterialInfo& info = table[static_cast<Material>(id)];
    if (info.visibility == Visibility::empty) continue;
    const bool is_same = info.visibility == row.visibility;
    if (has_same && !is_same) continue;
    const std::int64_t distance = colour_distance(info.colour, row.colour);
    if (is_same == has_same && distance >= least) continue;
    has_same = is_same;
    least = distance;
    nearest = static_cast<Material>(id);
  }
  return nearest;
}

}  // namespace runstone
