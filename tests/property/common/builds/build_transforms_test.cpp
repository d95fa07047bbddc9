#include "common/builds/build_transforms.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/builds/build_builder.hpp"
#include "common/core/hash.hpp"
#include "tests/support/builds/cell_grid.hpp"

namespace runstone::test {
namespace {

VoxelPos random_sides(SplitMix64& rng, std::int32_t most) {
  return {rng.between(1, most), rng.between(1, most), rng.between(1, most)};
}

Orientation any_orientation(SplitMix64& rng) {
  return *Orientation::of_byte(static_cast<std::uint8_t>(rng.between(0, kOrientationCount - 1)));
}

}  // namespace

TEST_CASE("a build has the cells from which it was made, and so has each box of it",
          "[builds][property]") {
  SplitMix64 rng{3 + Catch::rngSeed()};
  for (int round = 0; round < 150; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const CellGrid cells = random_cells(rng, random_sides(rng, 40), 5);
    const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, cells.sides(), 20));
    REQUIRE(build);
    REQUIRE(broken_invariant(*build) == "");
    REQUIRE(cells_of(*build) == cells);
    for (int i = 0; i < 6; ++i) {
      const VoxelPos s = cells.sides();
      const VoxelPos min{rng.between(0, s.x - 1), rng.between(0, s.y - 1), rng.between(0, s.z - 1)};
      const VoxelPos max{rng.between(min.x + 1, s.x), rng.between(min.y + 1, s.y),
                         rng.between(min.z + 1, s.z)};
      const RunChunk part = cells_in(*build, {min, max});
      REQUIRE(validate_runs(part).has_value());
      for_each_cell({max.x - min.x, max.y - min.y, max.z - min.z}, [&](VoxelPos c) {
        const std::uint16_t number =
            material_at(part, {static_cast<std::uint8_t>(c.x), static_cast<std::uint8_t>(c.y),
                               static_cast<std::uint8_t>(c.z)});
        const GridCell cell = number == 0 ? GridCell{} : build->material(number);
        REQUIRE(cell == cells.at({min.x + c.x, min.y + c.y, min.z + c.z}));
      });
      const VoxelPos corner{rng.between(-9, s.x), rng.between(-9, s.y), rng.between(-9, s.z)};
      const RunChunk shown = materials_in(
          *build, {corner, {corner.x + 12, corner.y + 7, corner.z + rng.between(1, 15)}});
      REQUIRE(validate_runs(shown).has_value());
      for_each_cell({12, 7, shown.extent.z}, [&](VoxelPos c) {
        const VoxelPos at{corner.x + c.x, corner.y + c.y, corner.z + c.z};
        const bool is_inside =
            at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < s.x && at.y < s.y && at.z < s.z;
        const Material wanted = is_inside ? cells.at(at).value_or(kEmpty) : kEmpty;
        REQUIRE(material_at(shown, {static_cast<std::uint8_t>(c.x), static_cast<std::uint8_t>(c.y),
                                    static_cast<std::uint8_t>(c.z)}) == wanted);
      });
    }
  }
}

TEST_CASE("a turned build lies as the definition of its orientation says", "[builds][property]") {
  SplitMix64 rng{5 + Catch::rngSeed()};
  for (std::uint8_t byte = 0; byte < kOrientationCount; ++byte) {
    const Orientation orientation = *Orientation::of_byte(byte);
    for (int round = 0; round < 3; ++round) {
      CAPTURE(Catch::rngSeed(), int{byte}, round);
      const CellGrid cells = random_cells(rng, random_sides(rng, 30), 4);
      const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, cells.sides(), 17));
      const auto made = turned(*build, orientation);
      REQUIRE(made);
      REQUIRE(broken_invariant(**made) == "");
      REQUIRE(cells_of(**made) == turned_cells(cells, orientation));
    }
  }
}

TEST_CASE("two transforms one after another are their composition", "[builds][property]") {
  SplitMix64 rng{7 + Catch::rngSeed()};
  for (int round = 0; round < 150; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const CellGrid cells = random_cells(rng, random_sides(rng, 25), 4);
    const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, cells.sides(), 12));
    const Orientation first = any_orientation(rng);
    const int quarters = rng.between(-3, 3);
    const Axis axis = static_cast<Axis>(rng.between(0, 2));
    const Orientation turn = Orientation{}.rotated_about_y(quarters);
    const Orientation mirror = Orientation{}.mirrored(axis);
    const BuildPtr once = *turned(*build, first);
    // The composition by the functions of Orientation, with which pastes are turned.
    REQUIRE(cells_of(**turned(*once, turn)) ==
            cells_of(**turned(*build, first.rotated_about_y(quarters))));
    REQUIRE(cells_of(**turned(*once, mirror)) == cells_of(**turned(*build, first.mirrored(axis))));
    REQUIRE(cells_of(**turned(**turned(*once, mirror), mirror)) == cells_of(*once));
  }
}

TEST_CASE("a stack has each copy at its place, and later copies lie over earlier ones",
          "[builds][property]") {
  SplitMix64 rng{9 + Catch::rngSeed()};
  int rows = 0, overlaps = 0;
  for (int round = 0; round < 150; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const CellGrid cells = random_cells(rng, random_sides(rng, 20), 4);
    const VoxelPos s = cells.sides();
    const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, s, 12));
    const std::int32_t times = rng.between(1, 4);
    VoxelPos offset{rng.between(-9, 9), rng.between(-9, 9), rng.between(-9, 9)};
    if (round % 3 == 0) offset = {0, (round % 2 == 0 ? 1 : -1) * (s.y + rng.between(0, 70)), 0};
    if (round % 3 == 1) offset = {s.x, 0, 0};
    if (offset == VoxelPos{}) continue;
    const auto made = stacked(*build, offset, times);
    REQUIRE(made);
    REQUIRE(broken_invariant(**made) == "");
    const VoxelPos corner = stack_corner(offset, times);
    CellGrid wanted({std::abs(offset.x) * times + s.x, std::abs(offset.y) * times + s.y,
                     std::abs(offset.z) * times + s.z});
    for (std::int32_t i = 0; i <= times; ++i) {
      for_each_cell(s, [&](VoxelPos c) {
        if (const GridCell cell = cells.at(c)) {
          wanted.set({c.x + i * offset.x - corner.x, c.y + i * offset.y - corner.y,
                      c.z + i * offset.z - corner.z},
                     cell);
        }
      });
    }
    REQUIRE(cells_of(**made) == wanted);
    if (round % 3 == 1) {
      ++rows;
      CHECK((*made)->distinct_sections().size() == build->distinct_sections().size());
    }
    overlaps += std::abs(offset.x) < s.x && std::abs(offset.y) < s.y && std::abs(offset.z) < s.z;
  }
  CHECK(rows > 40);
  CHECK(overlaps > 10);
}

TEST_CASE("new materials replace those of the palette, and cells without one become untouched",
          "[builds][property]") {
  SplitMix64 rng{11 + Catch::rngSeed()};
  int lost = 0;
  for (int round = 0; round < 100; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const CellGrid cells = random_cells(rng, random_sides(rng, 25), 6);
    const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, cells.sides(), 12));
    std::vector<std::optional<Material>> palette;
    for (std::size_t i = 0; i < build->palette().size(); ++i) {
      palette.emplace_back(static_cast<Material>(rng.between(0, 9)));
      if (rng.between(0, 1) == 0) palette.back().reset();
    }
    CellGrid wanted(cells.sides());
    for_each_cell(cells.sides(), [&](VoxelPos c) {
      const GridCell cell = cells.at(c);
      if (!cell) return;
      const auto& old = build->palette();
      std::size_t i = 0;
      while (old[i] != *cell) ++i;
      wanted.set(c, palette[i]);
    });
    const auto made = with_materials(*build, palette);
    REQUIRE(made.has_value() == wanted.any());
    if (!made) {
      ++lost;
      continue;
    }
    REQUIRE(broken_invariant(**made) == "");
    REQUIRE(cells_of(**made) == wanted);
  }
  CHECK(lost > 0);
}

}  // namespace runstone::test
