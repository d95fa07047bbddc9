#include "common/builds/build.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/builds/build_builder.hpp"
#include "common/builds/build_transforms.hpp"
#include "common/builds/paste_source.hpp"
#include "common/core/build_info.hpp"
#include "common/core/hash.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/builds/cell_grid.hpp"

namespace runstone::test {
namespace {

BuildCuts cube_cuts(std::int32_t side, std::int32_t edge) {
  const auto along = grid_cuts(side, edge);
  return {along, along, along};
}

/// Makes ground of 512 voxels a side, as a flat world has it: stone below, one layer of hills, air.
BuildPtr ground_512() {
  SplitMix64 rng{512};
  auto out = BuildBuilder::of(cube_cuts(512, 64));
  const std::uint16_t air = *out->number_of(kEmpty), stone = *out->number_of(1);
  const std::uint16_t grass = *out->number_of(2);
  const SectionPos counts{8, 8, 8};
  for (SectionPos at; at.z < counts.z; ++at.z) {
    for (at.y = 0; at.y < counts.y; ++at.y) {
      for (at.x = 0; at.x < counts.x; ++at.x) {
        if (at.y != 3) {
          REQUIRE(out->put(at, uniform_chunk(Extent::cube(64), at.y < 3 ? stone : air)));
          continue;
        }
        RunBuilder hills(Extent::cube(64), AxisOrder::yxz);
        for (int column = 0; column < 64 * 64; ++column) {
          const auto height = static_cast<std::uint32_t>(rng.between(20, 40));
          hills.append(height, stone);
          hills.append(1, grass);
          hills.append(63 - height, air);
        }
        REQUIRE(out->put(at, hills.finish()));
      }
    }
  }
  return *out->finish();
}

}  // namespace

TEST_CASE("cuts of a grid begin and end with the side", "[builds]") {
  CHECK(grid_cuts(1, 64) == std::vector<std::int32_t>{0, 1});
  CHECK(grid_cuts(64, 64) == std::vector<std::int32_t>{0, 64});
  CHECK(grid_cuts(70, 32) == std::vector<std::int32_t>{0, 32, 64, 70});
  CHECK(grid_cuts(70, 32, 30) == std::vector<std::int32_t>{0, 2, 34, 66, 70});
}

TEST_CASE("uniform sections are one object, and a build without a touched cell is refused",
          "[builds]") {
  auto out = BuildBuilder::of(cube_cuts(256, 64));
  REQUIRE(out);
  const std::uint16_t stone = *out->number_of(7);
  static_cast<void>(out->number_of(9));  // no cell gets it
  for (std::uint32_t x = 0; x < 3; ++x)
    REQUIRE(out->put({x, 1, 2}, uniform_chunk(Extent::cube(64), stone)));
  const auto build = out->finish();
  REQUIRE(build);
  CHECK((*build)->distinct_sections().size() == 2);
  CHECK((*build)->palette() == std::vector<Material>{7});
  CHECK((*build)->touched() == 3 * 64 * 64 * 64);
  CHECK((*build)->at({191, 64, 128}) == Material{7});
  CHECK_FALSE((*build)->at({192, 64, 128}));
  CHECK(broken_invariant(**build) == "");
  auto none = BuildBuilder::of(cube_cuts(64, 64));
  const auto refused = none->finish();
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::bad_value);
}

TEST_CASE("a build that takes more memory than allowed is refused when the bound is reached",
          "[builds]") {
  CHECK(BuildBuilder::of(cube_cuts(512, 64), 1000).error().code == ErrorCode::limit_exceeded);
  CHECK(BuildBuilder::of({grid_cuts(kBuildSideMax + 1, 64), {0, 1}, {0, 1}}).error().what ==
        std::string("build is longer than 1,048,576 voxels"));
  const std::vector<std::int32_t> longest = grid_cuts(kBuildSideMax, 1);
  CHECK(BuildBuilder::of({longest, longest, longest}).error().code == ErrorCode::limit_exceeded);
  SplitMix64 rng{4};
  auto out = BuildBuilder::of(cube_cuts(512, 64), 3'000'000);
  REQUIRE(out);
  for (unsigned i = 0; i < 8; ++i) static_cast<void>(out->number_of(static_cast<Material>(i)));
  std::string refused;
  std::uint32_t put = 0;
  for (; put < 8 && refused.empty(); ++put) {
    RunBuilder noise(Extent::cube(64), AxisOrder::xyz);
    for (std::uint32_t i = 0; i < 64 * 64 * 64; ++i)
      noise.append(1, static_cast<std::uint16_t>(rng.between(0, 8)));
    const auto done = out->put({put, 0, 0}, noise.finish());
    if (!done) refused = done.error().what;
  }
  CHECK(refused == "build takes too much memory");
  CHECK(put ==
        3);  // the third is refused: 262,144 voxels of noise are about 230,000 runs of 6 bytes
}

TEST_CASE("ground of 512 voxels a side is copied, turned, stacked and pasted without a dense grid",
          "[builds]") {
  const std::uint64_t before = dense_expansions();
  const BuildPtr ground = ground_512();
  CHECK(ground->volume() == 512ULL * 512 * 512);
  CHECK(ground->memory_bytes() < 8'000'000);
  CHECK(ground->distinct_sections().size() == 64 + 2);
  const auto turn = turned(*ground, Orientation{}.rotated_about_y(1));
  REQUIRE(turn);
  CHECK((*turn)->memory_bytes() < 8'000'000);
  const auto mirror = turned(*ground, Orientation{}.mirrored(Axis::y));
  REQUIRE(mirror);
  CHECK((*mirror)->at({0, 0, 0}) == kEmpty);
  CHECK((*mirror)->at({0, 511, 0}) == Material{1});
  const auto stack = stacked(*ground, {0, 512, 0}, 3);
  REQUIRE(stack);
  CHECK((*stack)->touched() == 4 * ground->touched());
  CHECK((*stack)->memory_bytes() < ground->memory_bytes() + 20'000);

  PasteSource source(ground, {-100, 64, 31}, {}, EmptyCells::skipped, {});
  std::uint64_t voxels = 0;
  std::size_t edits = 0, bytes = 0;
  while (const auto edit = source.next()) {
    voxels += counted_voxels(*edit);
    bytes += encode(*edit).size();
    ++edits;
  }
  CHECK(voxels == ground->solid());
  CHECK(edits < 900);
  CHECK(bytes < 3'000'000);
  CHECK(dense_expansions() == before);
}

TEST_CASE("a clipboard and the build of it have equal cells", "[builds]") {
  ClipboardBuilder cells({3, 2, 1});
  cells.append(1, Material{5});
  cells.append(2, std::nullopt);
  cells.append(3, kEmpty);
  const auto clipboard = *cells.finish();
  const BuildPtr build = build_of(*clipboard);
  CHECK(broken_invariant(*build) == "");
  CHECK(build->at({0, 0, 0}) == Material{5});
  CHECK_FALSE(build->at({1, 0, 0}));
  CHECK(build->at({2, 1, 0}) == kEmpty);
  CHECK(*whole_clipboard(*build, EmptyCells::pasted, {}) == *clipboard);
  CHECK(whole_clipboard(*build, EmptyCells::skipped, {})->touched() == 1);
}

TEST_CASE("a stack without an offset, or longer than a build may be, is refused", "[builds]") {
  const BuildPtr build = build_of(*[] {
    ClipboardBuilder cells({1, 1, 1});
    cells.append(1, Material{5});
    return *cells.finish();
  }());
  CHECK(stacked(*build, {}, 1).error().code == ErrorCode::bad_value);
  CHECK(stacked(*build, {1 << 29, 0, 0}, INT32_MAX).error().what ==
        std::string("build is longer than 1,048,576 voxels"));
  CHECK(stacked(*build, {0, -(1 << 18), 0}, 3));
  CHECK_FALSE(stacked(*build, {0, -(1 << 18), 0}, 4));
  CHECK(stacked(*build, {1 << 18, 1 << 18, 1 << 18}, 3).error().code == ErrorCode::limit_exceeded);
}

}  // namespace runstone::test
