// Exposure: counts the drawn faces of voxels and finds the most exposed voxel of each cell of
// 2 x 2 x 2, for 64 voxels of a line at a time. Counts of 64 voxels are three rows of bits, added
// and compared by logic. Internal to tiles. Source: bit-sliced counters (Hacker's Delight, 5-1,
// carry-save adders).
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "common/runs/axis_order.hpp"
#include "common/runs/bit_row.hpp"
#include "common/tiles/layer_rows.hpp"

namespace runstone::tiles {

/// Four layers of the children around one layer of the tile. The two in the middle become the
/// layer of the tile.
struct LayerWindow {
  const LayerRows* before = nullptr;
  std::array<const LayerRows*, 2> middle{};
  const LayerRows* behind = nullptr;
};

/// The most exposed voxel of each cell of one layer of the tile. Entry m + i * edge of a list is
/// word i of the line m. Only even bits count: bit 2 * f belongs to the cell f. Each bit is the
/// coordinate of the voxel in the cell along the fastest, middle and slowest axis.
struct MostExposed {
  std::vector<Row64> f, m, s;
};

class ExposureSweep {
 public:
  void reset(unsigned edge);
  /// Finds the most exposed voxel of each cell. Requires layers with rows, whose same_before is
  /// known for the second to fourth layer. Cost: O(lines * words).
  void find(const LayerWindow& window, AxisOrder order, MostExposed& out);

 private:
  std::size_t edge_ = 0, words_ = 0;
  // Number of drawn faces of the lines of two layers: bits of weight 1, 2 and 4. The lines of a
  // cell are numbered by m + 2 * s.
  std::array<std::array<std::vector<Row64>, 3>, 4> counts_;
};

}  // namespace runstone::tiles
