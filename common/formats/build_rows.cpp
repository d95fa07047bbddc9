#include "common/formats/build_rows.hpp"

#include <algorithm>
#include <cstddef>

#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kSlabLayers = 16;
constexpr auto kWalkTile = static_cast<std::int32_t>(kSideMax);

/// The runs of a tile of a slab, from the cell that comes next.
class TileWalk {
 public:
  explicit TileWalk(RunChunk cells) : cells_(std::move(cells)) {}
  std::uint32_t row() const { return cells_.extent.x; }

  /// Calls f(count, number) for the next `count` cells. Returns false if f did.
  template <class F>
  bool take(std::uint32_t count, const F& f) {
    const std::uint32_t end = at_ + count;
    while (at_ < end) {
      const std::uint32_t run_end = cells_.runs.end(run_);
      const std::uint32_t part = std::min(run_end, end) - at_;
      if (!f(part, cells_.runs.material(run_))) return false;
      at_ += part;
      if (at_ == run_end) ++run_;
    }
    return true;
  }

 private:
  RunChunk cells_;  // in the order x, z, y
  std::size_t run_ = 0;
  std::uint32_t at_ = 0;
};

/// Joins cells of one number.
class JoinedCells {
 public:
  explicit JoinedCells(const BuildRowSink& sink) : sink_(sink) {}
  bool add(std::uint64_t count, std::uint16_t number) {
    if (number != number_ && !flush()) return false;
    number_ = number;
    count_ += count;
    return true;
  }
  bool flush() {
    const bool is_taken = count_ == 0 || sink_(count_, number_);
    count_ = 0;
    return is_taken;
  }

 private:
  const BuildRowSink& sink_;
  std::uint64_t count_ = 0;
  std::uint16_t number_ = 0;
};

bool walk_slab(const Build& build, std::int32_t low_y, std::int32_t high_y, JoinedCells& out) {
  const VoxelPos sides = build.sides();
  const auto add = [&](std::uint64_t count, std::uint16_t number) {
    return out.add(count, number);
  };
  // Tiles by rows of tiles: along x, then along z.
  std::vector<std::vector<TileWalk>> tiles;
  for (std::int32_t z = 0; z < sides.z; z += kWalkTile) {
    tiles.emplace_back();
    for (std::int32_t x = 0; x < sides.x; x += kWalkTile) {
      const VoxelBox box{
          {x, low_y, z},
          {std::min(x + kWalkTile, sides.x), high_y, std::min(z + kWalkTile, sides.z)}};
      tiles.back().emplace_back(reorder(cells_in(build, box), AxisOrder::xzy));
    }
  }
  for (std::int32_t y = low_y; y < high_y; ++y) {
    for (std::int32_t z = 0; z < sides.z; ++z) {
      for (TileWalk& tile : tiles[static_cast<std::size_t>(z / kWalkTile)]) {
        if (!tile.take(tile.row(), add)) return false;
      }
    }
  }
  return true;
}

}  // namespace

bool walk_build_rows(const Build& build, const BuildRowSink& sink) {
  JoinedCells out(sink);
  const std::int32_t height = build.sides().y;
  for (std::int32_t y = 0; y < height; y += kSlabLayers) {
    if (!walk_slab(build, y, std::min(y + kSlabLayers, height), out)) return false;
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
