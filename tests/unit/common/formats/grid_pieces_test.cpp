#include "common/formats/grid_pieces.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <string>

#include "common/core/hash.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::test {
namespace {

std::array<std::int32_t, 3> numbers_of(VoxelPos at) { return {at.x, at.y, at.z}; }

/// The cells of a box one after the other, in an order of the axes.
struct ListedCells {
  VoxelBox box;
  AxisOrder order;
  std::vector<Material> cells;

  std::int32_t side(std::size_t axis) const {
    return numbers_of(box.max)[axis] - numbers_of(box.min)[axis];
  }
  Material at(VoxelPos pos) const {
    const auto axes = axes_of(order);
    std::size_t index = 0;
    for (std::size_t i = 3; i-- > 0;) {
      const auto axis = static_cast<std::size_t>(axes[i]);
      index = index * static_cast<std::size_t>(side(axis)) +
              static_cast<std::size_t>(numbers_of(pos)[axis] - numbers_of(box.min)[axis]);
    }
    return cells[index];
  }
};

ListedCells random_cells(SplitMix64& rng, const VoxelBox& box, AxisOrder order) {
  ListedCells out{box, order, {}};
  const auto count = static_cast<std::size_t>(out.side(0) * out.side(1) * out.side(2));
  while (out.cells.size() < count) {
    const auto stretch = static_cast<std::size_t>(rng.between(1, rng.below(4) == 0 ? 3000 : 40));
    out.cells.insert(out.cells.end(), std::min(stretch, count - out.cells.size()),
                     static_cast<Material>(rng.below(6)));
  }
  return out;
}

std::vector<ForeignBlock> five_blocks() {
  std::vector<ForeignBlock> out;
  for (int i = 1; i <= 5; ++i) out.push_back({std::to_string(i), ""});
  return out;
}

}  // namespace

TEST_CASE("the pieces of a box are its cells, cut at the planes of the grid", "[formats]") {
  SplitMix64 rng{11};
  const std::vector<ForeignBlock> blocks = five_blocks();
  for (const VoxelBox& box : {VoxelBox{{0, 0, 0}, {3, 2, 1}}, VoxelBox{{-70, 60, 5}, {70, 70, 20}},
                              VoxelBox{{-5, -64, 0}, {5, 66, 64}}, VoxelBox{{1, 1, 1}, {9, 9, 140}},
                              VoxelBox{{63, -1, -65}, {66, 1, 65}}}) {
    for (const AxisOrder order : kAxisOrders) {
      CAPTURE(box.min.x, static_cast<int>(order));
      const ListedCells listed = random_cells(rng, box, order);
      std::uint64_t seen = 0, wrong = 0;
      const PieceSink sink = [&](ForeignPiece&& piece) -> Result<void> {
        REQUIRE(validate_runs(piece.voxels));
        const auto sides = piece.voxels.extent.sides();
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::int32_t low = numbers_of(piece.origin)[axis], high = low + sides[axis];
          CHECK((low % 64 == 0 || low == numbers_of(box.min)[axis]));
          CHECK((high % 64 == 0 || high == numbers_of(box.max)[axis]));
          CHECK(sides[axis] <= 64);
        }
        seen += piece.voxels.extent.volume();
        for (std::uint32_t i = 0; i < piece.voxels.extent.volume(); ++i) {
          const LocalPos local = pos_of(i, piece.voxels.extent, piece.voxels.order);
          const Material found = material_at(piece.voxels, local);
          const Material expected = listed.at(
              {piece.origin.x + local.x, piece.origin.y + local.y, piece.origin.z + local.z});
          if (found == 0 ? expected != 0
                         : piece.blocks[found - 1U].name != std::to_string(expected))
            ++wrong;
        }
        return {};
      };
      GridPieces pieces(box, order, blocks, sink);
      CHECK(pieces.left() == listed.cells.size());
      for (std::size_t i = 0; i < listed.cells.size();) {
        std::size_t end = i + 1;
        while (end < listed.cells.size() && listed.cells[end] == listed.cells[i]) ++end;
        REQUIRE(pieces.append(end - i, listed.cells[i]));
        i = end;
      }
      CHECK(pieces.left() == 0);
      CHECK(seen == listed.cells.size());
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("very large layers have larger pieces, and sides have a bound", "[formats]") {
  const std::vector<ForeignBlock> blocks = five_blocks();
  std::uint64_t count = 0, cells = 0;
  const PieceSink sink = [&](ForeignPiece&& piece) -> Result<void> {
    ++count;
    cells += piece.voxels.extent.volume();
    return {};
  };
  GridPieces pieces({{0, 0, 0}, {1 << 15, 1, 1 << 14}}, AxisOrder::xzy, blocks, sink);
  REQUIRE(pieces.append(pieces.left(), 1));
  CHECK(count == 256 * 128);
  CHECK(cells == std::uint64_t{1} << 29);

  const auto fits = [](VoxelPos sides) { return GridPieces::are_sides(sides, AxisOrder::xyz); };
  CHECK(fits({1 << 14, 1 << 14, 1 << 20}));
  CHECK_FALSE(fits({1 << 14, (1 << 14) + 1, 1}));
  CHECK_FALSE(fits({1, 1, (1 << 20) + 1}));
  CHECK_FALSE(fits({1, 0, 1}));
  CHECK_FALSE(fits({-1, 1, 1}));
}

TEST_CASE("a sink that fails ends the cutting", "[formats]") {
  const std::vector<ForeignBlock> blocks = five_blocks();
  int given = 0;
  const PieceSink sink = [&](ForeignPiece&&) -> Result<void> {
    if (++given < 3) return {};
    return fail(ErrorCode::limit_exceeded, "enough");
  };
  GridPieces pieces({{0, 0, 0}, {64, 64, 640}}, AxisOrder::xyz, blocks, sink);
  CHECK_FALSE(pieces.append(pieces.left(), 2));
  CHECK(given == 3);
}

}  // namespace runstone::test
