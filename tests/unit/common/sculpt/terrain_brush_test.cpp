#include "common/sculpt/terrain_brush.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "common/generate/value_noise.hpp"
#include "common/sculpt/brush_weights.hpp"
#include "common/sculpt/height_field.hpp"
#include "tests/unit/common/sculpt/hills.hpp"

namespace runstone::test {
namespace {

double distance(double x, double z, VoxelPos a, VoxelPos b) {
  const double dx = b.x - a.x, dz = b.z - a.z, square = dx * dx + dz * dz;
  double t = square > 0 ? ((x - a.x) * dx + (z - a.z) * dz) / square : 0;
  t = std::clamp(t, 0.0, 1.0);
  return std::hypot(x - a.x - t * dx, z - a.z - t * dz);
}

std::int32_t weight(const TerrainBrush& brush, const std::vector<VoxelPos>& places, std::int32_t x,
                    std::int32_t z) {
  double nearest = 1e9;
  for (std::size_t i = 0; i + 1 < std::max<std::size_t>(2, places.size()); ++i)
    nearest =
        std::min(nearest, distance(x, z, places[i], places[std::min(i + 1, places.size() - 1)]));
  const double t = nearest / (brush.radius + 0.5);
  if (t >= 1) return 0;
  const double share = brush.falloff == BrushFalloff::none     ? 1.0
                       : brush.falloff == BrushFalloff::linear ? 1 - t
                       : brush.falloff == BrushFalloff::round  ? std::sqrt(1 - t * t)
                                                               : 1 - t * t * (3 - 2 * t);
  return static_cast<std::int32_t>(std::lround(share * 256));
}

/// Returns the mean of the heights in a square, and of the means in a square, by brute force.
std::int64_t mean(const Hills& hills, const VoxelBox& box, std::int32_t x, std::int32_t z,
                  std::int32_t radius) {
  std::int64_t sum = 0, count = 0;
  const auto inside = [&](std::int32_t px, std::int32_t pz) {
    return px >= box.min.x && px < box.max.x && pz >= box.min.z && pz < box.max.z;
  };
  for (std::int32_t dz = -radius; dz <= radius; ++dz) {
    for (std::int32_t dx = -radius; dx <= radius; ++dx) {
      if (!inside(x + dx, z + dz)) continue;
      for (std::int32_t ez = -radius; ez <= radius; ++ez) {
        for (std::int32_t ex = -radius; ex <= radius; ++ex) {
          if (!inside(x + dx + ex, z + dz + ez)) continue;
          sum += hills.height(x + dx + ex, z + dz + ez) * 256;
          ++count;
        }
      }
    }
  }
  return static_cast<std::int64_t>(
      std::floor(static_cast<double>(sum) / static_cast<double>(count)));
}

struct Stroke {
  GroundColumns columns;
  PlacedBuild placed;
};

Stroke stroke(const Hills& hills, const TerrainBrush& brush, const std::vector<VoxelPos>& places) {
  VoxelBox box = brush_box(brush, places);
  box.min.y = std::max(box.min.y, Hills::kLow);
  box.max.y = std::min(box.max.y, Hills::kHigh);
  auto columns = GroundColumns::read(box, kHillEdge, hills);
  REQUIRE(columns);
  const auto changes = brush_changes(*columns, GroundMaterials::of(hills.table), brush, places);
  auto placed = build_of_changes(*columns, changes);
  REQUIRE(placed);
  return {*std::move(columns), *std::move(placed)};
}

/// Compares the build with columns whose surface lies at the heights that `to` gives. Cells that do
/// not differ from the world are untouched.
template <class F>
void check_heights(const Hills& hills, const Stroke& made, F&& to) {
  const VoxelBox& box = made.columns.box();
  const PlacedBuild& placed = made.placed;
  std::size_t wrong = 0, changed = 0;
  for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      const auto expected = hills.moved_column(x, z, to(x, z));
      for (std::int32_t y = Hills::kLow; y < Hills::kHigh; ++y) {
        const Material old = hills.at({x, y, z});
        std::optional<Material> cell;
        const VoxelPos local{x - placed.at.x, y - placed.at.y, z - placed.at.z};
        if (placed.build && placed.build->box().contains(local)) cell = placed.build->at(local);
        const Material wanted = expected[static_cast<std::size_t>(y - Hills::kLow)];
        if (wanted != old) ++changed;
        if (cell != (wanted == old ? std::nullopt : std::optional<Material>(wanted))) ++wrong;
      }
    }
  }
  CHECK(changed > 0);
  CHECK(wrong == 0);
}

/// Returns the height of the highest voxel of ground in a column to which the build was applied.
std::int32_t height_after(const Hills& hills, const Stroke& made, std::int32_t x, std::int32_t z) {
  const PlacedBuild& placed = made.placed;
  for (std::int32_t y = Hills::kHigh; y-- > Hills::kLow;) {
    std::optional<Material> cell;
    const VoxelPos local{x - placed.at.x, y - placed.at.y, z - placed.at.z};
    if (placed.build && placed.build->box().contains(local)) cell = placed.build->at(local);
    const Material now = cell.value_or(hills.at({x, y, z}));
    if (now == hills.grass || now == hills.dirt || now == hills.stone) return y;
  }
  return Hills::kLow - 1;
}

std::int32_t rounded(std::int64_t height) {
  return static_cast<std::int32_t>(std::floor((static_cast<double>(height) + 128) / 256));
}

const std::vector<VoxelPos> kLine = {{-20, 8, 3}, {5, 9, 10}, {11, 6, -14}};

}  // namespace

TEST_CASE("raise and lower move the surface with its soil, plants and water", "[sculpt]") {
  const Hills& hills = Hills::shared();
  TerrainBrush brush;
  brush.radius = GENERATE(1, 17);
  brush.strength = GENERATE(1, 17);
  brush.falloff = static_cast<BrushFalloff>(GENERATE(range(0, kBrushFalloffCount)));
  brush.lowers = GENERATE(false, true);
  CAPTURE(brush.radius, brush.strength, static_cast<int>(brush.falloff), brush.lowers);
  const auto made = stroke(hills, brush, kLine);
  check_heights(hills, made, [&](std::int32_t x, std::int32_t z) {
    const std::int32_t sign = brush.lowers ? -1 : 1;
    return rounded(hills.height(x, z) * 256 + sign * brush.strength * weight(brush, kLine, x, z));
  });
}

TEST_CASE("flatten moves the surface to the height of the first place", "[sculpt]") {
  const Hills& hills = Hills::shared();
  TerrainBrush brush;
  brush.mode = BrushMode::flatten;
  brush.radius = 12;
  brush.falloff = static_cast<BrushFalloff>(GENERATE(range(0, kBrushFalloffCount)));
  check_heights(hills, stroke(hills, brush, kLine), [&](std::int32_t x, std::int32_t z) {
    const std::int64_t height = hills.height(x, z) * 256;
    return rounded(height + (kLine[0].y * 256 - height) * weight(brush, kLine, x, z) / 256);
  });
}

TEST_CASE("smooth moves the surface to the mean of the heights around", "[sculpt]") {
  const Hills& hills = Hills::shared();
  TerrainBrush brush;
  brush.mode = BrushMode::smooth;
  brush.radius = 10;
  brush.strength = GENERATE(1, 3);
  const auto made = stroke(hills, brush, kLine);
  check_heights(hills, made, [&](std::int32_t x, std::int32_t z) {
    const std::int64_t height = hills.height(x, z) * 256;
    const std::int32_t part = weight(brush, kLine, x, z);
    if (part == 0) return hills.height(x, z);
    // The mean is rounded towards a height of the area, so it may differ by one part of a voxel.
    const std::int64_t target = mean(hills, made.columns.box(), x, z, brush.strength);
    return rounded(height + (target - height) * part / 256);
  });
}

TEST_CASE("erosion lowers steep steps, and keeps the sum of the heights", "[sculpt]") {
  constexpr std::int32_t kFieldSide = 24;
  std::vector<std::int32_t> heights(kFieldSide * kFieldSide);
  for (std::int32_t i = 0; i < kFieldSide * kFieldSide; ++i)
    heights[std::size_t(i)] = i % kFieldSide < 12 ? 20 : 0;
  heights[0] = kNoSurface;
  std::vector<std::int32_t> weights(heights.size(), kFullWeight);
  for (std::size_t i = 0; i < kFieldSide; ++i) weights[i * kFieldSide + 23] = 0;
  const HeightField before = height_field(heights, kFieldSide);
  const HeightField after = eroded(before, weights, 64);
  CHECK(std::accumulate(after.heights.begin(), after.heights.end(), std::int64_t{0}) ==
        std::accumulate(before.heights.begin(), before.heights.end(), std::int64_t{0}));
  CHECK(after.rounded(5 * kFieldSide + 11) < 15);
  CHECK(after.rounded(5 * kFieldSide + 12) > 5);
  for (std::size_t i = 0; i < kFieldSide; ++i) CHECK(after.heights[i * kFieldSide + 23] == 0);
  CHECK(after.heights[0] == 0);
  CHECK(eroded(before, weights, 0).heights == before.heights);
}

TEST_CASE("noise depends on the seed, and stays within the strength", "[sculpt]") {
  const Hills& hills = Hills::shared();
  TerrainBrush brush;
  brush.mode = BrushMode::noise;
  brush.falloff = BrushFalloff::none;
  brush.radius = 16;
  brush.strength = 5;
  const auto one = stroke(hills, brush, kLine);
  brush.seed = 2;
  const auto two = stroke(hills, brush, kLine);
  REQUIRE(one.placed.build);
  REQUIRE(two.placed.build);
  CHECK(one.placed.build->touched() != two.placed.build->touched());
  const VoxelBox& box = one.columns.box();
  std::int32_t most = 0;
  for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      const std::int32_t change = height_after(hills, one, x, z) - hills.height(x, z);
      most = std::max(most, std::abs(change));
      if (std::abs(change) > brush.strength) FAIL_CHECK(x << " " << z << ": " << change);
    }
  }
  CHECK(most > 1);
}

TEST_CASE("erosion moves each column to the height that the plain rule gives", "[sculpt]") {
  const Hills& hills = Hills::shared();
  TerrainBrush brush;
  brush.mode = BrushMode::erode;
  brush.radius = 9;
  brush.strength = GENERATE(1, 12);
  brush.falloff = GENERATE(BrushFalloff::smooth, BrushFalloff::none);
  const auto made = stroke(hills, brush, kLine);
  using Place = std::pair<std::int32_t, std::int32_t>;
  std::map<Place, std::int64_t> heights;  // of the columns of the stroke, in parts of a voxel
  const VoxelBox& box = made.columns.box();
  for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      if (weight(brush, kLine, x, z) > 0) heights[{x, z}] = hills.height(x, z) * 256;
    }
  }
  for (std::int32_t step = 0; step < brush.strength; ++step) {
    std::map<Place, std::int64_t> next = heights;
    for (const auto& [at, height] : heights) {
      std::map<Place, std::int64_t> lower;
      for (const Place& beside : {Place{at.first - 1, at.second}, Place{at.first + 1, at.second},
                                  Place{at.first, at.second - 1}, Place{at.first, at.second + 1}}) {
        const auto found = heights.find(beside);
        if (found != heights.end() && height - found->second > 256)
          lower[beside] = height - found->second - 256;
      }
      std::int64_t sum = 0, most = 0;
      for (const auto& [place, excess] : lower) {
        sum += excess;
        most = std::max(most, excess);
      }
      for (const auto& [place, excess] : lower) {
        const std::int64_t given = most / 2 * weight(brush, kLine, at.first, at.second) / 256;
        next[at] -= given * excess / sum;
        next[place] += given * excess / sum;
      }
    }
    heights = std::move(next);
  }
  check_heights(hills, made, [&](std::int32_t x, std::int32_t z) {
    const auto found = heights.find({x, z});
    return found == heights.end() ? hills.height(x, z) : rounded(found->second);
  });
}

TEST_CASE("noise moves each column by its noise and its weight", "[sculpt]") {
  const Hills& hills = Hills::shared();
  TerrainBrush brush;
  brush.mode = BrushMode::noise;
  brush.radius = GENERATE(2, 14);
  brush.strength = 9;
  brush.seed = 5;
  brush.lowers = GENERATE(false, true);
  const ValueNoise noise(5, 1.0 / std::max(4, brush.radius));
  check_heights(hills, stroke(hills, brush, kLine), [&](std::int32_t x, std::int32_t z) {
    const double part = (brush.lowers ? -9 : 9) * noise.at(x, z) * weight(brush, kLine, x, z);
    return rounded(hills.height(x, z) * 256 + static_cast<std::int64_t>(part));
  });
}

TEST_CASE("overlay changes the upper voxels of each column of the stroke, and no others",
          "[sculpt]") {
  const Hills& hills = Hills::shared();
  TerrainBrush brush;
  brush.mode = BrushMode::overlay;
  brush.falloff = GENERATE(BrushFalloff::none, BrushFalloff::linear);
  brush.radius = 7;
  brush.strength = GENERATE(1, 6);
  brush.material = hills.stone;
  const auto made = stroke(hills, brush, kLine);
  REQUIRE(made.placed.build);
  std::size_t wrong = 0, changed = 0;
  const VoxelBox& box = made.columns.box();
  for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      const std::int32_t top = hills.height(x, z);
      const bool is_in = weight(brush, kLine, x, z) >= 128;
      for (std::int32_t y = top - 7; y < top + 3; ++y) {
        const bool is_set =
            is_in && y <= top && y > top - brush.strength && hills.at({x, y, z}) != hills.stone;
        changed += is_set ? 1 : 0;
        const VoxelPos cell{x - made.placed.at.x, y - made.placed.at.y, z - made.placed.at.z};
        const auto is =
            made.placed.build->box().contains(cell) ? made.placed.build->at(cell) : std::nullopt;
        wrong += is != (is_set ? std::optional(hills.stone) : std::nullopt) ? 1 : 0;
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(made.placed.build->touched() == changed);
}

TEST_CASE("overlay and naturalise set the upper voxels of the ground", "[sculpt]") {
  const Hills& hills = Hills::shared();
  TerrainBrush brush;
  brush.mode = BrushMode::overlay;
  brush.falloff = BrushFalloff::none;
  brush.radius = 6;
  brush.strength = 2;
  brush.material = hills.stone;
  const auto made = stroke(hills, brush, kLine);
  REQUIRE(made.placed.build);
  const std::int32_t top = hills.height(5, 10);
  const VoxelPos at = made.placed.at;
  const auto cell = [&](std::int32_t y) {
    return made.placed.build->at({5 - at.x, y - at.y, 10 - at.z});
  };
  CHECK(cell(top) == hills.stone);
  CHECK(cell(top - 1) == hills.stone);
  brush.mode = BrushMode::naturalise;
  // The hills have natural layers already.
  CHECK(stroke(hills, brush, kLine).placed.build == nullptr);
}

TEST_CASE("naturalise gives bare columns the layers of most columns", "[sculpt]") {
  const Hills& hills = Hills::shared();
  const auto is_bare = [](std::int32_t x) { return x % 5 == 0; };
  const auto bare_hills = [&](ChunkCoord coord) {
    const VoxelPos o = origin_of(coord, kHillEdge);
    RunBuilder out(Extent::cube(kHillEdge), AxisOrder::xyz);
    for (std::int32_t z = o.z; z < o.z + kHillEdge; ++z) {
      for (std::int32_t y = o.y; y < o.y + kHillEdge; ++y) {
        for (std::int32_t x = o.x; x < o.x + kHillEdge; ++x) {
          const bool is_stone = is_bare(x) && y <= hills.height(x, z);
          out.append(1, is_stone ? hills.stone : hills.at({x, y, z}));
        }
      }
    }
    return std::make_shared<const RunChunk>(out.finish());
  };
  TerrainBrush brush;
  brush.mode = BrushMode::naturalise;
  brush.falloff = BrushFalloff::none;
  brush.radius = 6;
  const auto columns = GroundColumns::read(brush_box(brush, kLine), kHillEdge, bare_hills);
  REQUIRE(columns);
  const auto placed = build_of_changes(
      *columns, brush_changes(*columns, GroundMaterials::of(hills.table), brush, kLine));
  REQUIRE((placed && placed->build));
  std::size_t bare = 0, wrong = 0;
  const VoxelBox& box = columns->box();
  for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      const bool is_changed = is_bare(x) && weight(brush, kLine, x, z) > 0;
      bare += is_changed ? 1 : 0;
      const std::int32_t top = hills.height(x, z);
      for (std::int32_t y = top - 6; y < top + 3; ++y) {
        std::optional<Material> wanted;
        if (is_changed && y <= top && y > top - kSkinVoxels)
          wanted = y == top ? hills.grass : hills.dirt;
        const VoxelPos cell{x - placed->at.x, y - placed->at.y, z - placed->at.z};
        const auto is =
            placed->build->box().contains(cell) ? placed->build->at(cell) : std::nullopt;
        wrong += is != wanted ? 1 : 0;
      }
    }
  }
  CHECK(bare > 50);
  CHECK(wrong == 0);
  CHECK(placed->build->touched() == bare * kSkinVoxels);
}

TEST_CASE("a stroke that is lower than the box allows is cut to it", "[sculpt]") {
  const Hills& hills = Hills::shared();
  TerrainBrush brush;
  brush.radius = 3;
  brush.strength = kBrushStrengthMax;
  brush.lowers = true;
  brush.falloff = BrushFalloff::none;
  const auto made = stroke(hills, brush, kLine);
  // The skin of the ground stays in the box.
  const std::int32_t lowest = made.columns.box().min.y + kSkinVoxels;
  std::size_t cut = 0;
  check_heights(hills, made, [&](std::int32_t x, std::int32_t z) {
    const std::int32_t height = hills.height(x, z);
    if (weight(brush, kLine, x, z) == 0) return height;
    cut += height - kBrushStrengthMax < lowest ? 1 : 0;
    return std::max(height - kBrushStrengthMax, lowest);
  });
  CHECK(cut > 20);
}

}  // namespace runstone::test
