#include "common/model_writers/coarser_build.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/assert.hpp"
#include "common/mesh/visibility.hpp"
#include "common/model_writers/region_mesher.hpp"
#include "common/runs/cut.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/tile_rules.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kTileEdge = static_cast<std::int32_t>(kSideMax);

std::int32_t halved(std::int32_t side) { return (side + 1) / 2; }

class CoarserBuilder {
 public:
  CoarserBuilder(const WrittenBuild& source, BuildBuilder& out)
      : build_(source.build), visibility_(visibility_as_cubes(source)), out_(out) {}

  Result<void> put_all() {
    const auto count = [&](std::size_t axis) {
      return static_cast<std::uint32_t>(out_.cuts()[axis].size() - 1);
    };
    for (SectionPos at; at.z < count(2); ++at.z) {
      for (at.y = 0; at.y < count(1); ++at.y) {
        for (at.x = 0; at.x < count(0); ++at.x) {
          auto tile = tile_at(at);
          if (!tile) continue;
          if (auto done = out_.put(at, *std::move(tile)); !done) return done;
        }
      }
    }
    return {};
  }

 private:
  /// Returns the cells of a section of the coarser build, or nullopt if none is touched.
  std::optional<RunChunk> tile_at(SectionPos at) {
    std::array<RunChunk, 8> children;
    TileChildren pointers{};
    for (unsigned i = 0; i < 8; ++i) {
      const auto place = [&](std::uint32_t section, unsigned bit) {
        return static_cast<std::int32_t>(2 * section + (i >> bit & 1U)) * kTileEdge;
      };
      const VoxelPos min{place(at.x, 0), place(at.y, 1), place(at.z, 2)};
      children[i] =
          cells_around(build_, {min, {min.x + kTileEdge, min.y + kTileEdge, min.z + kTileEdge}});
      if (!is_empty(children[i])) pointers[i] = &children[i];
    }
    if (pointers == TileChildren{}) return std::nullopt;
    RunChunk tile =
        build_tile(pointers, static_cast<unsigned>(kTileEdge), kTileOrder, visibility_, scratch_);
    const auto side = [&](std::size_t axis, std::uint32_t section) {
      const std::vector<std::int32_t>& cuts = out_.cuts()[axis];
      return static_cast<std::uint8_t>(cuts[section + 1] - cuts[section]);
    };
    const Extent extent{side(0, at.x), side(1, at.y), side(2, at.z)};
    return extent == tile.extent ? std::move(tile) : cut(tile, {0, 0, 0}, extent);
  }

  const Build& build_;
  VisibilityTable visibility_;
  BuildBuilder& out_;
  TileScratch scratch_;
};

}  // namespace

bool can_be_coarser(const Build& build) {
  const VoxelPos sides = build.sides();
  return std::max({sides.x, sides.y, sides.z}) > 1;
}

Result<CoarserBuild> coarser_build(const WrittenBuild& source, std::size_t bytes_max) {
  const VoxelPos sides = source.build.sides();
  auto builder = BuildBuilder::of(
      {grid_cuts(halved(sides.x), kTileEdge), grid_cuts(halved(sides.y), kTileEdge),
       grid_cuts(halved(sides.z), kTileEdge)},
      bytes_max);
  if (!builder) return failure(builder.error());
  // As materials the builder takes the cell numbers of the source, and so gives each its own
  // number.
  for (std::size_t number = 1; number <= source.materials.size(); ++number)
    RUNSTONE_ASSERT(builder->number_of(static_cast<Material>(number)) == number);
  if (auto put = CoarserBuilder(source, *builder).put_all(); !put) return failure(put.error());
  auto build = builder->finish();
  if (!build) return failure(build.error());
  CoarserBuild out{*std::move(build), {}};
  bool is_shown = false;
  for (const Material number : out.build->palette()) {
    out.finer_numbers.push_back(number);
    is_shown = is_shown || source.materials[number - 1U].as_cube != Visibility::empty;
  }
  if (!is_shown) return fail(ErrorCode::bad_value, "model: coarser build shows no cube");
  return out;
}

}  // namespace runstone
