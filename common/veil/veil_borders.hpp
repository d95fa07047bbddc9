// VeilBorders: what lies beyond the six sides of a chunk, as far as it decides which voxels of the
// chunk are enclosed. A voxel beyond a side covers the voxel that it touches if it is opaque.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// How a side counts whose neighbour is missing.
///   - open: nothing beyond it covers, so the voxels at the side keep their materials. Tiles count
///     so, because a client may draw a tile beside anything.
///   - closed: all of it covers. Chunks count so: a voxel is told when its neighbour is known, and
///     not before.
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
  /// Makes the borders of a chunk of this extent and axis order, all of whose neighbours are
  /// missing.
  VeilBorders(Extent extent, AxisOrder order, MissingSide missing);
  /// Reads the neighbours of a chunk, in any axis order. A missing neighbour is null. Requires
  /// valid neighbours with the chunk's sides where they touch. Cost: O(runs of the neighbours).
  VeilBorders(const RunChunk& chunk, const std::array<const RunChunk*, kDirectionCount>& neighbours,
              const VisibilityTable& covers, MissingSide missing);
  /// Reads what lies beside some layers of the chunk. The rest is not known afterwards. Cost: for a
  /// few layers O(layers * (length + log runs)).
  VeilBorders(const RunChunk& chunk, const std::array<const RunChunk*, kDirectionCount>& neighbours,
              const VisibilityTable& covers, MissingSide missing, SlowLayers layers);

  Extent extent() const { return extent_; }
  AxisOrder order() const { return order_; }

  /// Returns the voxels beyond a side that cover, as a row of bits. `rank` is that of the axis
  /// across the side in the axis order. Bits lie along the fastest of the two other axes, and rows
  /// along the slowest.
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
