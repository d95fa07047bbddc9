// Which cover and which trees a place has. Near columns and far tiles decide it here alike.
#include <algorithm>

#include "common/generate/landscape/land_columns.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kBeachHeight = 2;  // voxels above the sea
constexpr std::int32_t kSnowLine = 400;
constexpr std::int32_t kScreeLine = 310;
constexpr std::int32_t kTreeLine = 250;
constexpr std::int32_t kForestFloorShare = 2000;

}  // namespace

LandCover cover_of(const LandPlace& place) {
  const std::int32_t cold_height = place.height + place.cold;
  const std::int32_t steep = 250 + place.grain * 24 / kOne;
  if (cold_height > kSnowLine + place.grain * 14 / kOne)
    return place.slope > steep + 150 ? LandCover::rock : LandCover::snow;
  if (place.height <= kBeachHeight && place.slope < 150) return LandCover::beach;
  if (place.slope > steep) return LandCover::rock;
  if (cold_height > kScreeLine + place.grain * 26 / kOne)
    return place.slope > 170 ? LandCover::rock : LandCover::scree;
  if (place.forest > kForestFloorShare && cold_height < kTreeLine) return LandCover::forest_floor;
  return LandCover::grass;
}

std::int32_t tree_share(const LandPlace& place, LandCover cover) {
  if (cover != LandCover::grass && cover != LandCover::forest_floor) return 0;
  const std::int32_t below_line = kOne - ramp(place.height + place.cold, kTreeLine - 60, kTreeLine);
  return times(55 + times(place.forest, 3500), below_line);
}

std::int32_t pine_share(const LandPlace& place) {
  return ramp(place.height + 2 * place.cold, 70, 210);
}

}  // namespace runstone
