#include "common/veil/veil_borders.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/opaque_layer.hpp"
#include "common/runs/layer_walk.hpp"

namespace runstone {
namespace {

constexpr std::size_t side_number(Direction side, AxisOrder order) {
  return static_cast<std::size_t>(rank_of(axis_of(side), order)) * 2 + (is_positive(side) ? 1 : 0);
}

}  // namespace

VeilBorders::VeilBorders(Extent extent, AxisOrder order, MissingSide missing)
    : extent_(extent), order_(order) {
  if (missing == MissingSide::open) return;
  for (std::size_t d = 0; d < kDirectionCount; ++d) set_missing(static_cast<Direction>(d), missing);
}

VeilBorders::VeilBorders(const RunChunk& chunk,
                         const std::array<const RunChunk*, kDirectionCount>& neighbours,
                         const VisibilityTable& covers, MissingSide missing)
    : VeilBorders(chunk, neighbours, covers, missing, all_slow_layers(chunk)) {}

VeilBorders::VeilBorders(const RunChunk& chunk,
                         const std::array<const RunChunk*, kDirectionCount>& neighbours,
                         const VisibilityTable& covers, MissingSide missing, SlowLayers layers)
    : extent_(chunk.extent), order_(chunk.order) {
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const auto side = static_cast<Direction>(d);
    if (neighbours[d] != nullptr) {
      read(side, *neighbours[d], covers, layers);
    } else {
      set_missing(side, missing);
    }
  }
}

void VeilBorders::set_missing(Direction side, MissingSide missing) {
  // No caller reads bits and rows outside of the chunk.
  sides_[side_number(side, order_)].fill(missing == MissingSide::closed ? ~Row128{0} : 0);
}

template <class Row>
void VeilBorders::read_rows(Side& side, Direction direction, const RunChunk& neighbour,
                            const VisibilityTable& covers, SlowLayers layers) {
  const auto axes = axes_of(order_);
  const Axis across = axis_of(direction);
  const Axis bits = axes[0] == across ? axes[1] : axes[0];
  const std::uint32_t depth = neighbour.extent.sides()[static_cast<std::size_t>(across)];
  if (across == axes[2]) {
    // Only the first or the last layer of the chunk touches this side, with all its lines.
    const OrderedExtent e = ordered(extent_, order_);
    if (is_positive(direction) ? layers.end != e.s : layers.first != 0) return;
    layers = {0, e.m};
  }
  std::array<Row, kRowBits<Row>> rows;
  read_opaque_layer(
      neighbour, {across, bits, is_positive(direction) ? 0 : depth - 1, layers.first, layers.end},
      covers, rows);
  std::copy(rows.begin() + layers.first, rows.begin() + layers.end, side.begin() + layers.first);
}

void VeilBorders::read(Direction side, const RunChunk& neighbour, const VisibilityTable& covers,
                       SlowLayers layers) {
  const auto own = extent_.sides(), beyond = neighbour.extent.sides();
  for (std::size_t axis = 0; axis < own.size(); ++axis)
    RUNSTONE_ASSERT(axis == static_cast<std::size_t>(axis_of(side)) || own[axis] == beyond[axis]);
  Side& rows = sides_[side_number(side, order_)];
  if (neighbour.is_uniform()) {
    rows.fill(covers[neighbour.runs.material(0)] == Visibility::opaque ? ~Row128{0} : 0);
  } else if (layers.empty()) {
    return;
  } else if (*std::max_element(beyond.begin(), beyond.end()) <= kRowBits<Row64>) {
    read_rows<Row64>(rows, side, neighbour, covers, layers);
  } else {
    read_rows<Row128>(rows, side, neighbour, covers, layers);
  }
}

SlowLayers all_slow_layers(const RunChunk& chunk) {
  return {0, ordered(chunk.extent, chunk.order).s};
}

}  // namespace runstone
