#include "common/formats/grid_cells.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kWalkLayers = 16;
constexpr auto kWalkTile = static_cast<std::int32_t>(kSideMax);
constexpr std::uint32_t kStretchCells = 65'536;

/// Joins cells of one number.
class JoinedCells {
 public:
  explicit JoinedCells(const CellSink& sink) : sink_(sink) {}
  Result<void> add(std::uint32_t count, std::uint16_t number) {
    if (number != number_ || count_ >= kStretchCells) {
      if (auto done = flush(); !done) return done;
    }
    number_ = number;
    count_ += count;
    return {};
  }
  Result<void> flush() {
    const std::uint32_t count = std::exchange(count_, 0);
    return count == 0 ? Result<void>() : sink_(count, number_);
  }

 private:
  const CellSink& sink_;
  std::uint32_t count_ = 0;
  std::uint16_t number_ = 0;
};

/// The runs of a tile of a slab, from the cell that comes next.
class TileWalk {
 public:
  /// `line`: the cells along the fastest axis.
  TileWalk(RunChunk cells, std::int32_t line)
      : cells_(std::move(cells)), line_(static_cast<std::uint32_t>(line)) {}

  /// Gives the next line.
  Result<void> give_line(JoinedCells& out) {
    for (const std::uint32_t end = at_ + line_; at_ < end;) {
      const Run run = cells_.runs[run_];
      const std::uint32_t stop = std::min(run.end, end);
      if (auto done = out.add(stop - at_, run.material); !done) return done;
      at_ = stop;
      if (stop == run.end) ++run_;
    }
    return {};
  }

 private:
  RunChunk cells_;  // in the order of the walk
  std::uint32_t line_;
  std::size_t run_ = 0;
  std::uint32_t at_ = 0;
};

}  // namespace

Result<void> walk_cells(const Build& build, AxisOrder order, const CellSink& sink) {
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
  JoinedCells out(sink);
  const auto wide = static_cast<std::size_t>((sides[0] + kWalkTile - 1) / kWalkTile);
  std::vector<TileWalk> tiles;
  for (std::int32_t slab = 0; slab < sides[2]; slab += kWalkLayers) {
    const std::int32_t slab_end = std::min(slab + kWalkLayers, sides[2]);
    tiles.clear();
    for (std::int32_t middle = 0; middle < sides[1]; middle += kWalkTile) {
      const std::int32_t middle_end = std::min(middle + kWalkTile, sides[1]);
      for (std::int32_t fast = 0; fast < sides[0]; fast += kWalkTile) {
        const std::int32_t fast_end = std::min(fast + kWalkTile, sides[0]);
        const VoxelBox box{position({fast, middle, slab}),
                           position({fast_end, middle_end, slab_end})};
        tiles.emplace_back(reorder(cells_in(build, box), order), fast_end - fast);
      }
    }
    for (std::int32_t layer = slab; layer < slab_end; ++layer) {
      for (std::int32_t middle = 0; middle < sides[1]; ++middle) {
        const std::size_t row = static_cast<std::size_t>(middle / kWalkTile) * wide;
        for (std::size_t i = row; i < row + wide; ++i) {
          if (auto done = tiles[i].give_line(out); !done) return done;
        }
      }
    }
  }
  return out.flush();
}

std::vector<std::uint64_t> count_cells(const Build& build) {
  std::vector<std::uint64_t> copies(build.distinct_sections().size());
  for (const std::uint32_t section : build.grid()) ++copies[section];
  std::vector<std::uint64_t> counts(build.palette().size() + 1);
  for (std::size_t i = 0; i < copies.size(); ++i) {
    build.distinct_sections()[i]->runs.visit([&](const auto& runs) {
      std::uint32_t begin = 0;
      for (std::size_t run = 0; run < runs.size(); ++run) {
        counts[runs.material(run)] += copies[i] * (runs.end(run) - begin);
        begin = runs.end(run);
      }
    });
  }
  return counts;
}

}  // namespace runstone
