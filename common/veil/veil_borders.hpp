// VeilBorders: the covering voxels beyond the six sides of a chunk. They decide which voxels at the
// sides are enclosed.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The treatment of a side whose neighbour is missing.
///   - open: no voxel beyond the side covers, so the voxels at the side keep their materials. Tiles
///     have open sides, because a client may draw a tile beside anything.
///   - closed: every voxel beyond the side covers. Chunks have closed sides, so a voxel is sent
///     only when its neighbour is known.
enum class MissingSide : std::uint8_t { open, closed };

/// Layers [first, end) of the slowest axis of a chunk.
struct SlowLayers {
  std::uint32_t first = 0, end = 0;
  bool empty() const { return first >= end; }
  friend bool operator==(const SlowLayers&, const SlowLayers&) = default;
};

/// Returns all layers of a chunk.
SlowLayers all_slow_layers(const RunChunk& chunk);

class VeilBorders {
 public:
  /// Makes the borders of a chunk of this extent and axis order. All of its neighbours are missing.
  VeilBorders(Extent extent, AxisOrder order, MissingSide missing);
  /// Reads the neighbours of a chunk, in any axis order. A missing neighbour is null. Requires
  /// valid neighbours with the chunk's sides where they touch. Cost: O(runs of the neighbours).
  VeilBorders(const RunChunk& chunk, const std::array<const RunChunk*, kDirectionCount>& neighbours,
              const VisibilityTable& covers, MissingSide missing);
  /// Reads the voxels beside some layers of the chunk only. Rows beside other layers are not valid
  /// afterwards. Cost: for a few layers O(layers * (length + log runs)).
  VeilBorders(const RunChunk& chunk, const std::array<const RunChunk*, kDirectionCount>& neighbours,
              const VisibilityTable& covers, MissingSide missing, SlowLayers layers);

  Extent extent() const { return extent_; }
  AxisOrder order() const { return order_; }

  /// Returns the voxels beyond a side that cover, as a row of bits. `rank` is the place of the axis
  /// across the side in the axis order. Bits lie along the faster of the two other axes, and rows
  /// along the slower one.
  template <class Row>
  Row row(int rank, bool positive, std::uint32_t row) const {
    return static_cast<Row>(sides_[static_cast<std::size_t>(rank) * 2 + (positive ? 1 : 0)][row]);
  }

 private:
  using Side = std::array<Row128, kSideMax>;
  void set_missing(Direction side, MissingSide missing);
  void read(Direction side, const RunChunk& neighbour, const VisibilityTable& covers,
            SlowLayers layers);
  template <class Row>
  void read_rows(Side& side, Direction direction, const RunChunk& neighbour,
                 const VisibilityTable& covers, SlowLayers layers);

  Extent extent_;
  AxisOrder order_;
  std::array<Side, kDirectionCount> sides_{};  // by rank, the negative side first
};

}  // namespace runstone
