#include "common/generate/landscape/land_form.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "common/core/hash.hpp"
#include "common/core/integer_root.hpp"

namespace runstone {
namespace {

constexpr std::size_t kPatchesKept = 1024;
constexpr std::int64_t kReachSquared = std::int64_t{kDrainageReach} * 16 * kDrainageReach * 16;
constexpr std::int64_t kNearSquared = 24 * 16 * 24 * 16;  // within 24 voxels a level stays as it is

std::array<LatticeNoise, 4> octaves(std::uint64_t key) {
  return {LatticeNoise(key, 9), LatticeNoise(key + 1, 8), LatticeNoise(key + 2, 7),
          LatticeNoise(key + 3, 6)};
}

std::int32_t weighted(const std::array<LatticeNoise, 4>& noise, const std::array<int, 4>& weights,
                      std::int32_t x, std::int32_t z) {
  std::int32_t out = 0;
  for (std::size_t i = 0; i < 4; ++i) out += noise[i].at(x, z) * weights[i];
  return out;
}

/// Returns how far the side of a valley rises, in voxels, at `away` voxels from its bottom and a
/// slope of one: slowly at first, and less again towards the ridge, where it would end at `most`.
std::int32_t valley_side(std::int32_t away, std::int32_t most) {
  const std::int64_t soft = std::int64_t{away} * away * 16 / (away + 56);
  return static_cast<std::int32_t>(soft * most * 16 / (most * 16 + soft));  // sixteenths
}

}  // namespace

LandForm::LandForm(std::uint64_t seed)
    : drainage_(seed),
      warp_x_(octaves(mix64(seed + 1))),
      warp_z_(octaves(mix64(seed + 2))),
      crags_(octaves(mix64(seed + 3))),
      swell_8_(mix64(seed + 4), 8),
      swell_7_(mix64(seed + 5), 7),
      hills_11_(mix64(seed + 6), 11),
      forest_10_(mix64(seed + 7), 10),
      forest_8_(mix64(seed + 8), 8),
      cold_11_(mix64(seed + 9), 11),
      patches_(kPatchesKept) {}

LandForm::DrainagePlace LandForm::drainage_place(std::int32_t x, std::int32_t z,
                                                 std::int32_t warp_x, std::int32_t warp_z) {
  const std::int64_t at_x = std::int64_t{x} * 16 + warp_x, at_z = std::int64_t{z} * 16 + warp_z;
  constexpr unsigned kBits = kDrainageBits + 4;
  constexpr std::int64_t kMask = (1 << kBits) - 1;
  return {static_cast<std::int32_t>(at_x >> kBits), static_cast<std::int32_t>(at_z >> kBits),
          static_cast<std::int32_t>(at_x & kMask), static_cast<std::int32_t>(at_z & kMask)};
}

LandSample LandForm::at(std::int32_t x, std::int32_t z) const {
  LandSample out;
  constexpr std::array<int, 4> kWarp = {110, 56, 30, 11};  // voxels
  out.warp_x = weighted(warp_x_, kWarp, x, z) >> 8;
  out.warp_z = weighted(warp_z_, kWarp, x, z) >> 8;
  const DrainagePlace place = drainage_place(x, z, out.warp_x, out.warp_z);

  // The level is that of all watercourses around, each with a weight that grows without bound
  // towards it. So a river has its own level, and the ground between two rivers blends both.
  std::int64_t weights = 0, levels = 0;
  std::int32_t nearest = std::numeric_limits<std::int32_t>::max() / 2;
  out.shore = nearest;
  out.water = 0;
  for (const Watercourse& course : *drainage_.square(place.square_x, place.square_z)) {
    const WatercoursePoint point = nearest_point(course, place.x, place.z);
    if (point.distance_squared >= kReachSquared) continue;
    const std::int64_t inside = (kReachSquared - point.distance_squared) >> 13;
    const std::int64_t weight =
        ((inside * inside) << 20) / ((point.distance_squared + kNearSquared) >> 4);
    weights += weight;
    levels += weight * point.level;
    const std::int64_t most = std::int64_t{std::max(nearest, out.shore)} + point.half_width;
    if (most <= 0 || point.distance_squared >= most * most) continue;
    const std::int32_t away =
        static_cast<std::int32_t>(integer_root(point.distance_squared)) - point.half_width;
    nearest = std::min(nearest, away);
    if (course.is_wet && away < out.shore) {
      out.shore = away;
      out.water = point.level >> 8;
    }
  }
  const auto level = static_cast<std::int32_t>(weights > 0 ? levels / weights : -30 * 256);

  const std::int32_t land = drainage_.continent(x, z);
  const std::int32_t mountain = drainage_.mountain_share(x, z);
  const std::int32_t hills = ramp(hills_11_.at(x, z), -1400, 1800);
  const std::int32_t ashore = ramp(land, -500, 500);
  // The slope of the sides of valleys.
  const std::int32_t slope = 120 + times(times(hills, ashore), 1350) + times(mountain, 3300);
  const std::int32_t away = std::max(0, nearest / 16 - 8);
  const std::int32_t rise =
      times(valley_side(away, 640 + times(mountain, 600)), slope) * 16;  // 256ths
  const std::int32_t off_water = ramp(away, 4, 140);
  // Crags are ridges at each scale, as high as the side of the valley lets them be.
  std::int32_t crag = 0;
  constexpr std::array<int, 4> kCrag = {30, 21, 8, 4};
  for (std::size_t i = 0; i < 4; ++i) crag += (kOne - 2 * std::abs(crags_[i].at(x, z))) * kCrag[i];
  crag = times(crag >> 6, times(off_water, rise * 9 / 20 + times(mountain, 20 * 256)));
  const std::int32_t swell =
      times((swell_8_.at(x, z) * 7 + swell_7_.at(x, z) * 3) >> 1, off_water) * 256 / kOne;
  out.height = std::clamp(level + 200 + rise + crag + swell, (kLandHeightMin + 8) * 256,
                          (kLandHeightMax - 40) * 256);
  out.roughness = mountain;
  out.cold = cold_11_.at(x, z) * 40 / kOne;
  const std::int32_t woods =
      forest_10_.at(x, z) + forest_8_.at(x, z) / 2 + hills / 8 + mountain / 5;
  out.forest = ramp(woods, 150, 1250);
  return out;
}

std::shared_ptr<const LandForm::Patch> LandForm::patch(std::int32_t x, std::int32_t z) const {
  return patches_.get({x, z}, [&] {
    Patch out;
    for (std::size_t k = 0; k < kPatchSide; ++k) {
      for (std::size_t i = 0; i < kPatchSide; ++i) {
        out.places[i + kPatchSide * k] =
            at(x * kPatchWidth + kLandStep * static_cast<std::int32_t>(i),
               z * kPatchWidth + kLandStep * static_cast<std::int32_t>(k));
      }
    }
    return out;
  });
}

}  // namespace runstone
