#include "common/formats/grid_cells.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kGridSlab = 64, kGridTile = 128;

/// A box of the slab, read line by line.
struct WalkedTile {
  RunChunk cells;
  std::uint32_t line = 0;
  std::size_t run = 0;
  std::uint32_t at = 0;
};

}  // namespace

Result<void> walk_cells(const Build& build, AxisOrder order,
                        const std::function<Result<void>(std::uint32_t, std::uint16_t)>& f) {
  const auto axes = axes_of(order);
  const VoxelPos whole = build.sides();
  const std::array<std::int32_t, 3> by_axis = {whole.x, whole.y, whole.z};
  std::array<std::int32_t, 3> sides{};  // fastest, middle, slowest
  for (std::size_t i = 0; i < 3; ++i) sides[i] = by_axis[static_cast<std::size_t>(axes[i])];
  const auto position = [&](const std::array<std::int32_t, 3>& by_order) {
    std::array<std::int32_t, 3> at{};
    for (std::size_t i = 0; i < 3; ++i) at[static_cast<std::size_t>(axes[i])] = by_order[i];
    return VoxelPos{at[0], at[1], at[2]};
  };
  const auto wide = static_cast<std::size_t>((sides[0] + kGridTile - 1) / kGridTile);
  std::vector<WalkedTile> tiles;
  for (std::int32_t s = 0; s < sides[2]; s += kGridSlab) {
    const std::int32_t end_s = std::min(s + kGridSlab, sides[2]);
    tiles.clear();
    for (std::int32_t m = 0; m < sides[1]; m += kGridTile) {
      const std::int32_t end_m = std::min(m + kGridTile, sides[1]);
      for (std::int32_t fast = 0; fast < sides[0]; fast += kGridTile) {
        const std::int32_t end_f = std::min(fast + kGridTile, sides[0]);
        const VoxelBox box{position({fast, m, s}), position({end_f, end_m, end_s})};
        tiles.push_back(
            {reorder(cells_in(build, box), order), static_cast<std::uint32_t>(end_f - fast)});
      }
    }
    for (std::int32_t layer = s; layer < end_s; ++layer) {
      for (std::int32_t m = 0; m < sides[1]; ++m) {
        const std::size_t row = static_cast<std::size_t>(m / kGridTile) * wide;
        for (std::size_t i = row; i < row + wide; ++i) {
          WalkedTile& tile = tiles[i];
          for (const std::uint32_t end = tile.at + tile.line; tile.at < end;) {
            const Run run = tile.cells.runs[tile.run];
            const std::uint32_t stop = std::min(run.end, end);
            if (auto done = f(stop - tile.at, run.material); !done) return done;
            tile.at = stop;
            if (stop == run.end) ++tile.run;
          }
        }
      }
    }
  }
  return {};
}

}  // namespace runstone
