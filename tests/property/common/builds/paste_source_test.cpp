#include "common/builds/paste_source.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <string>

#include "common/builds/build_builder.hpp"
#include "common/core/hash.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/support/builds/cell_grid.hpp"
#include "tests/support/edits/edit_oracle.hpp"

namespace runstone::test {
namespace {

/// The edits of a source, written to a grid voxel by voxel by the oracle of edits.
struct Pasted {
  CellGrid cells;
  std::size_t edits = 0;
  std::string fault;  // the first rule that an edit breaks
};

Pasted paste_all(PasteSource& source, VoxelPos at, VoxelPos sides, const Mask& mask,
                 const PasteLimits& limits) {
  Pasted out{CellGrid(sides), 0, {}};
  std::uint64_t done = 0;
  while (const auto edit = source.next()) {
    ++out.edits;
    const auto fail = [&](const char* what) {
      if (out.fault.empty()) out.fault = what;
    };
    if (!validate(*edit)) fail("not valid");
    if (edit->mask != mask) fail("another mask");
    if (counted_voxels(*edit) > limits.volume_max) fail("too many voxels");
    if (touched_chunks_bound(*edit, limits.chunk_edge) > limits.chunks_max) fail("too many chunks");
    const auto* const paste = std::get_if<Paste>(&edit->shape);
    if (paste != nullptr && paste->clipboard->byte_size() > limits.clipboard_bytes_max)
      fail("too many bytes");
    const VoxelBox box = bounding_box(*edit);
    for_each_cell({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z},
                  [&](VoxelPos c) {
                    const VoxelPos voxel{box.min.x + c.x, box.min.y + c.y, box.min.z + c.z};
                    const auto written = oracle_writes(*edit, voxel);
                    if (!written) return;
                    const VoxelPos cell{voxel.x - at.x, voxel.y - at.y, voxel.z - at.z};
                    if (cell.x < 0 || cell.y < 0 || cell.z < 0 || cell.x >= sides.x ||
                        cell.y >= sides.y || cell.z >= sides.z)
                      return fail("a voxel outside the build");
                    if (out.cells.at(cell)) fail("a voxel twice");
                    out.cells.set(cell, written);
                  });
    if (source.cells_done() <= done || source.cells_done() > source.cells()) fail("no progress");
    done = source.cells_done();
  }
  if (source.cells_done() != source.cells()) out.fault += " unfinished";
  return out;
}

CellGrid without_empty(CellGrid cells) {
  for_each_cell(cells.sides(), [&](VoxelPos c) {
    if (cells.at(c) == GridCell{kEmpty}) cells.set(c, std::nullopt);
  });
  return cells;
}

}  // namespace

TEST_CASE("the edits of a paste together are exactly the build at its place",
          "[builds][property]") {
  SplitMix64 rng{21 + Catch::rngSeed()};
  std::size_t cut = 0, whole = 0;
  for (int round = 0; round < 120; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const bool is_long = round % 4 == 0;
    const VoxelPos sides{rng.between(1, is_long ? 170 : 40), rng.between(1, 40),
                         rng.between(1, is_long ? 140 : 40)};
    const CellGrid cells = random_cells(rng, sides, 5);
    const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, sides, 60));
    PasteLimits limits;
    limits.chunk_edge = 16 << rng.between(0, 3);
    if (round % 2 == 0) limits.volume_max = static_cast<std::uint64_t>(rng.between(1, 3000));
    if (round % 3 == 0) limits.clipboard_bytes_max = static_cast<std::size_t>(rng.between(12, 300));
    if (round % 5 == 0) limits.chunks_max = static_cast<std::uint64_t>(rng.between(1, 9));
    const VoxelPos at{rng.between(-200, 200), rng.between(-200, 200), rng.between(-200, 200)};
    const Mask mask = round % 2 == 0 ? Mask{} : Mask{MaskKind::only_material, 3};
    const EmptyCells empty = round % 7 < 3 ? EmptyCells::skipped : EmptyCells::pasted;
    PasteSource source(build, at, mask, empty, limits);
    const Pasted pasted = paste_all(source, at, sides, mask, limits);
    REQUIRE(pasted.fault == "");
    REQUIRE(pasted.cells == (empty == EmptyCells::skipped ? without_empty(cells) : cells));
    const auto one = whole_clipboard(*build, empty, limits);
    if (one) {
      ++whole;
      REQUIRE(pasted.edits == 1);
    } else {
      ++cut;
    }
    REQUIRE_FALSE(source.next());
    source.restart();
    REQUIRE(source.next().has_value() == (pasted.edits != 0));
  }
  CHECK(whole > 20);
  CHECK(cut > 20);
}

TEST_CASE("the oracle of pastes finds a voxel that is lost, one that is set twice and one outside",
          "[builds]") {
  SplitMix64 rng{5};
  CellGrid cells({70, 3, 3});
  for_each_cell(cells.sides(), [&](VoxelPos c) {
    cells.set(c, static_cast<Material>((c.x + c.y + c.z) % 2 + 1));
  });
  const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, cells.sides(), 30));
  const PasteLimits limits;
  const VoxelPos at{1, 2, 3};
  PasteSource good(build, at, {}, EmptyCells::pasted, limits);
  CHECK(paste_all(good, at, cells.sides(), {}, limits).cells == cells);
  CellGrid other = cells;
  other.set({69, 2, 2}, std::nullopt);
  PasteSource lost(build_of_cells(rng, other, random_cuts(rng, cells.sides(), 30)), at, {},
                   EmptyCells::pasted, limits);
  CHECK_FALSE(paste_all(lost, at, cells.sides(), {}, limits).cells == cells);
  PasteSource moved(build, {2, 2, 3}, {}, EmptyCells::pasted, limits);
  CHECK(paste_all(moved, at, cells.sides(), {}, limits).fault == "a voxel outside the build");
  PasteLimits few = limits;
  few.volume_max = 10;
  PasteSource long_one(build, at, {}, EmptyCells::pasted, limits);
  CHECK(paste_all(long_one, at, cells.sides(), {}, few).fault == "too many voxels");
}

TEST_CASE("a large paste touches each chunk in consecutive edits, from below to above",
          "[builds][property]") {
  SplitMix64 rng{23 + Catch::rngSeed()};
  for (const std::int32_t edge : {16, 32, 64, 128}) {
    CAPTURE(Catch::rngSeed(), edge);
    const CellGrid cells = random_cells(rng, {200, 60, 180}, 4);
    const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, cells.sides(), 60));
    PasteLimits limits;
    limits.chunk_edge = edge;
    limits.clipboard_bytes_max = 200;
    PasteSource source(build, {-77, -33, 15}, {}, EmptyCells::pasted, limits);
    std::map<ChunkCoord, std::size_t> last;
    std::set<ChunkCoord> left;
    std::size_t i = 0;
    while (const auto edit = source.next()) {
      ++i;
      for (const ChunkCoord chunk : touched_chunks(*edit, edge)) {
        const auto found = last.find(chunk);
        // The edits of one block stand together.
        if (found != last.end()) CHECK(left.count(chunk) == 0);
        last[chunk] = i;
      }
      // A chunk two layers of blocks below is never touched again.
      const std::int32_t y = chunk_of(bounding_box(*edit).min, std::max(edge, 64)).y;
      for (const auto& [chunk, when] : last) {
        if (floor_div(chunk.y * edge, std::max(edge, 64)) < y) left.insert(chunk);
      }
    }
    CHECK(i > 10);
  }
}

}  // namespace runstone::test
