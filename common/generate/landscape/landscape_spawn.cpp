// The place where players arrive in a landscape: level and dry ground without trees. Places with a
// wide view of water and mountains are preferred.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <tuple>
#include <utility>
#include <vector>

#include "common/generate/landscape/landscape_generator.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kSearchReach = 1536;  // voxels around the origin, on each axis
constexpr std::int32_t kSearchStep = 48;
constexpr std::int32_t kClearing = 4;  // columns around the place that are level and without trees
constexpr std::int32_t kLevelGround = 2;  // voxels between the highest and the lowest of them
constexpr std::int32_t kEyes = 2;         // voxels above the ground
constexpr std::array<std::int32_t, 7> kSights = {50, 120, 280, 600, 1300, 2800, 5600};
/// Sixteen directions, times 256. Players arrive with the view to +z.
constexpr std::array<std::pair<std::int32_t, std::int32_t>, 16> kDirections = {{{0, 256},
                                                                                {98, 237},
                                                                                {-98, 237},
                                                                                {181, 181},
                                                                                {-181, 181},
                                                                                {237, 98},
                                                                                {-237, 98},
                                                                                {256, 0},
                                                                                {-256, 0},
                                                                                {237, -98},
                                                                                {-237, -98},
                                                                                {181, -181},
                                                                                {-181, -181},
                                                                                {98, -237},
                                                                                {-98, -237},
                                                                                {0, -256}}};
constexpr std::size_t kForward = 5;  // the first directions, which the arriving player sees

bool is_meadow(const LandForm& form, std::int32_t x, std::int32_t z) {
  const LandSample at = form.at(x, z);
  if (at.height < 3 * 256 || at.height > 200 * 256 || at.shore < 6 * 16) return false;
  if (at.forest > 700 || at.roughness > 2600) return false;
  for (const std::int32_t aside : {-10, 10}) {
    if (std::abs(form.at(x + aside, z).height - at.height) > 2 * 256 ||
        std::abs(form.at(x, z + aside).height - at.height) > 2 * 256)
      return false;
  }
  return true;
}

/// Returns the worth of the view from the place: points for ground, water and mountains in sight.
/// The directions that an arriving player looks to count three times.
std::int32_t view_of(const LandForm& form, std::int32_t x, std::int32_t z) {
  const std::int32_t eye = form.at(x, z).height + kEyes * 256;
  std::int32_t out = 0;
  for (std::size_t d = 0; d < kDirections.size(); ++d) {
    const auto [dx, dz] = kDirections[d];
    std::int32_t horizon = -kOne;  // the steepest way up so far: voxels for each 4096 voxels away
    std::int32_t seen = 0;
    for (const std::int32_t away : kSights) {
      const LandSample at = form.at(x + dx * away / 256, z + dz * away / 256);
      const std::int32_t crown = at.forest > 2000 ? 7 * 256 : 0;
      const std::int32_t height = std::max(at.height, 0);
      const std::int32_t angle = (height - eye) * 16 / away;
      if (angle < horizon) continue;
      seen += 2;
      if (at.height < 0 || at.shore < 0) seen += away < 1500 ? 9 : 4;
      if (away >= 1300 && at.roughness > 800) seen += std::clamp(angle, 0, 600) / 12;
      horizon = std::max(horizon, (height + crown - eye) * 16 / away);
    }
    out += d < kForward ? 3 * seen : seen;
  }
  return out;
}

}  // namespace

std::optional<VoxelPos> LandscapeGenerator::spawn() const {
  struct Place {
    std::int32_t x, z, worth;
  };
  std::vector<Place> places;
  for (std::int32_t z = -kSearchReach; z <= kSearchReach; z += kSearchStep) {
    for (std::int32_t x = -kSearchReach; x <= kSearchReach; x += kSearchStep) {
      if (!is_meadow(form_, x, z)) continue;
      const std::int32_t away = std::max(std::abs(x), std::abs(z));
      places.push_back({x, z, view_of(form_, x, z) - away / 16});
    }
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tuple(b.worth, a.z, a.x) < std::tuple(a.worth, b.z, b.x);
  });
  for (const Place& place : places) {
    constexpr std::int32_t kClearingSide = 2 * kClearing + 1;
    const LandColumns land(form_, materials_, choices_, seed_, place.x - kClearing,
                           place.z - kClearing, kClearingSide, kClearingSide);
    const auto [lowest, highest] = std::minmax_element(
        land.columns().begin(), land.columns().end(),
        [](const LandColumn& a, const LandColumn& b) { return a.ground < b.ground; });
    const bool is_dry = std::all_of(land.columns().begin(), land.columns().end(),
                                    [](const LandColumn& c) { return c.water == c.ground; });
    if (!is_dry || !land.wood().empty() || !land.hollows().empty() ||
        highest->ground - lowest->ground > kLevelGround)
      continue;
    const LandColumn& middle = land.columns()[kClearing + kClearingSide * kClearing];
    return VoxelPos{place.x, sea_level_ + middle.ground + kEyes, place.z};
  }
  return std::nullopt;
}

}  // namespace runstone
