#include "common/formats/rsb_build.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/core/hash.hpp"
#include "common/runs/dense.hpp"
#include "tests/support/builds/cell_grid.hpp"

namespace runstone::test {
namespace {

MaterialRow named_row(std::string name) {
  MaterialRow row;
  row.name = std::move(name);
  if (row.name == "air") row.visibility = Visibility::empty;
  return row;
}

/// Returns rows whose names are in another order than the palette.
std::vector<MaterialRow> rows_of(const Build& build) {
  std::vector<MaterialRow> rows;
  for (const Material material : build.palette())
    rows.push_back(named_row(material == kEmpty ? "air" : "m" + std::to_string(9 - material)));
  return rows;
}

Bytes bytes_of_build(const Build& build, std::span<const MaterialRow> rows, bool skips_empty) {
  Bytes out;
  BuildInfo info;
  info.name = "clipboard";
  std::vector<BuildMaterial> materials;
  for (const MaterialRow& row : rows) materials.push_back({row, {}});
  const auto written = write_build(build, materials, info, skips_empty, [&](ByteView bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
    return true;
  });
  INFO((written ? "" : written.error().message()));
  REQUIRE(written.has_value());
  return out;
}

/// Returns the names of the cells.
std::string name_at(const FileBuild& read, VoxelPos at) {
  const auto material = read.build->at(at);
  if (!material) return "";
  return read.materials[*read.build->number_of(*material) - 1U].row.name;
}

}  // namespace

TEST_CASE("a build that was written and read has its cells, with materials of the same names",
          "[formats]") {
  SplitMix64 rng{31};
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    const bool is_long = round % 4 == 0;
    const VoxelPos sides{rng.between(1, is_long ? 150 : 40), rng.between(1, 40),
                         rng.between(1, is_long ? 130 : 40)};
    CellGrid cells = random_cells(rng, sides, 6);
    cells.set({0, 0, 0}, Material{3});  // not only air
    const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, sides, 60));
    const std::vector<MaterialRow> rows = rows_of(*build);
    const bool skips_empty = round % 2 == 0;
    const std::uint64_t dense = dense_expansions();
    const Bytes file = bytes_of_build(*build, rows, skips_empty);
    const auto read = read_build(rsb_source(file));
    REQUIRE(read.has_value());
    CHECK(dense_expansions() == dense);
    REQUIRE(broken_invariant(*read->build) == "");
    REQUIRE(read->build->sides() == sides);
    REQUIRE(read->materials.size() == read->build->palette().size());
    for_each_cell(sides, [&](VoxelPos c) {
      const GridCell cell = cells.at(c);
      std::string wanted;
      if (cell && !(skips_empty && *cell == kEmpty))
        wanted = *cell == kEmpty ? "air" : "m" + std::to_string(9 - *cell);
      REQUIRE(name_at(*read, c) == wanted);
    });
  }
}

TEST_CASE("a build that takes too much memory, or a cut file, is refused", "[formats]") {
  SplitMix64 rng{32};
  const CellGrid cells = random_cells(rng, {100, 30, 100}, 5);
  const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, cells.sides(), 50));
  const Bytes file = bytes_of_build(*build, rows_of(*build), false);
  const auto large = read_build(rsb_source(file), 500);
  REQUIRE_FALSE(large.has_value());
  CHECK(large.error().error.code == ErrorCode::limit_exceeded);
  for (std::size_t bytes = 0; bytes < file.size(); bytes += 7)
    CHECK_FALSE(read_build(rsb_source(ByteView(file).first(bytes))).has_value());
}

TEST_CASE("a row without a name gets one from its number", "[formats]") {
  SplitMix64 rng{33};
  CellGrid cells({2, 1, 1});
  cells.set({0, 0, 0}, Material{7});
  cells.set({1, 0, 0}, Material{2});
  const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, cells.sides(), 2));
  const std::vector<MaterialRow> rows(2);
  const Bytes file = bytes_of_build(*build, rows, false);
  const auto read = read_build(rsb_source(file));
  REQUIRE(read.has_value());
  CHECK(name_at(*read, {0, 0, 0}) == "material 7");
  CHECK(name_at(*read, {1, 0, 0}) == "material 2");
}

}  // namespace runstone::test
