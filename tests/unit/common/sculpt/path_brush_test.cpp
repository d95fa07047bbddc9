#include "common/sculpt/path_brush.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "common/runs/run_builder.hpp"

namespace runstone::test {
namespace {

constexpr Material kStone = 1, kRoad = 2;
constexpr std::int32_t kSide = 32;

/// Stone up to a height that rises along x, with a gorge at x 20 .. 29.
std::int32_t slope_height(std::int32_t x) { return x >= 20 && x < 30 ? -20 : x / 8; }

std::shared_ptr<const RunChunk> slope_chunk(ChunkCoord coord) {
  const VoxelPos o = origin_of(coord, kSide);
  RunBuilder out(Extent::cube(kSide), AxisOrder::yxz);
  for (std::int32_t z = 0; z < kSide; ++z) {
    for (std::int32_t x = 0; x < kSide; ++x) {
      for (std::int32_t y = 0; y < kSide; ++y)
        out.append(1, o.y + y <= slope_height(o.x + x) ? kStone : kEmpty);
    }
  }
  return std::make_shared<RunChunk>(out.finish());
}

/// Returns the voxels that a way changes, by place.
std::map<VoxelPos, Material> way(const PathBrush& brush, const std::vector<VoxelPos>& places) {
  const auto curve = curve_through(places);
  const auto columns = GroundColumns::read(path_box(brush, curve), kSide, slope_chunk);
  REQUIRE(columns);
  std::map<VoxelPos, Material> out;
  for (const ColumnChange& change : path_changes(*columns, GroundMaterials(), brush, curve)) {
    const auto width = static_cast<std::size_t>(columns->width());
    const std::int32_t x = columns->box().min.x + static_cast<std::int32_t>(change.column % width);
    const std::int32_t z = columns->box().min.z + static_cast<std::int32_t>(change.column / width);
    for (std::int32_t y = change.low; y < change.high; ++y) {
      CHECK(out.emplace(VoxelPos{x, y, z}, change.material).second);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a curve goes through its places in small steps", "[sculpt]") {
  const std::vector<VoxelPos> places = {
      {0, 0, 0}, {10, 3, 0}, {10, 3, 0}, {12, 4, 30}, {-5, 0, 31}};
  const auto curve = curve_through(places);
  for (const VoxelPos& place : places) {
    const bool is_met = std::any_of(curve.begin(), curve.end(), [&](const CurvePoint& p) {
      return std::hypot(p.x - place.x - 0.5, p.y - place.y - 0.5, p.z - place.z - 0.5) < 1e-9;
    });
    CHECK(is_met);
  }
  for (std::size_t i = 1; i < curve.size(); ++i) {
    CHECK(std::hypot(curve[i].x - curve[i - 1].x, curve[i].y - curve[i - 1].y,
                     curve[i].z - curve[i - 1].z) <= 0.5);
  }
  CHECK(curve_through(std::vector<VoxelPos>{{1, 2, 3}}).size() == 1);
}

TEST_CASE("a way on the ground replaces the upper voxel of each column", "[sculpt]") {
  const auto changed = way({3, PathHeight::ground, kRoad}, {{0, 0, 4}, {12, 1, 4}, {18, 2, 4}});
  for (std::int32_t x = 0; x <= 18; ++x) {
    for (std::int32_t z = 3; z <= 5; ++z) {
      const auto at = changed.find({x, slope_height(x), z});
      REQUIRE(at != changed.end());
      CHECK(at->second == kRoad);
    }
  }
  for (const auto& [at, material] : changed) CHECK(at.y == slope_height(at.x));
}

TEST_CASE("a way changes what the rule for each voxel says", "[sculpt]") {
  const PathBrush brush{GENERATE(1, 2, 5, 8), GENERATE(PathHeight::ground, PathHeight::even),
                        kRoad};
  CAPTURE(brush.width, static_cast<int>(brush.height));
  const std::vector<VoxelPos> places = {{2, 3, 4}, {19, 1, 9}, {36, 6, 2}, {44, 5, 15}};
  const auto changed = way(brush, places);
  const auto curve = curve_through(places);
  const double shift = brush.width % 2 == 0 ? 0.5 : 0;
  std::map<VoxelPos, Material> wanted;
  for (std::int32_t z = -12; z < 30; ++z) {
    for (std::int32_t x = -12; x < 60; ++x) {
      double nearest = brush.width * brush.width / 4.0;
      const CurvePoint* found = nullptr;
      for (const CurvePoint& point : curve) {
        const double off_x = x + 0.5 - point.x - shift, off_z = z + 0.5 - point.z - shift;
        const double square = off_x * off_x + off_z * off_z;
        if (square > nearest || (found != nullptr && square == nearest)) continue;
        nearest = square;
        found = &point;
      }
      if (found == nullptr) continue;
      const std::int32_t top = slope_height(x), road = static_cast<std::int32_t>(found->y);
      if (brush.height == PathHeight::ground) {
        wanted[{x, top, z}] = kRoad;
        continue;
      }
      for (std::int32_t y = top + 1; top >= road - kPathFillMax && y < road; ++y)
        wanted[{x, y, z}] = kStone;
      wanted[{x, road, z}] = kRoad;
      for (std::int32_t y = road + 1; y <= std::min(top, road + kPathHeadroom); ++y)
        wanted[{x, y, z}] = kEmpty;
    }
  }
  CHECK(wanted.size() > 20);
  CHECK(changed == wanted);
}

TEST_CASE("an even way cuts, fills and bridges", "[sculpt]") {
  const auto changed = way({3, PathHeight::even, kRoad}, {{4, 3, 4}, {40, 3, 4}});
  const auto at = [&](VoxelPos p) {
    const auto found = changed.find(p);
    return found == changed.end() ? std::optional<Material>() : found->second;
  };
  for (std::int32_t x = 5; x < 40; ++x) CHECK(at({x, 3, 4}) == kRoad);
  CHECK(at({10, 2, 4}) == kStone);        // filled up from height 1
  CHECK(at({25, 2, 4}) == std::nullopt);  // the gorge is bridged
  CHECK(at({38, 4, 4}) == kEmpty);        // cut from height 4
  CHECK(at({25, 4, 4}) == std::nullopt);
}

}  // namespace runstone::test
