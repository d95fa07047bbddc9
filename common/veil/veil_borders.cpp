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
    : extent_(chunk.extent), order_(chunk.order) {
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const auto side = static_cast<Direction>(d);
    if (neighbours[d] != nullptr) {
      read(side, *neighbours[d], covers);
    } else {
      set_missing(side, missing);
    }
  }
}

void VeilBorders::set_missing(Direction side, MissingSide missing) {
  // Bits and rows outside of the chunk are not read.
  sides_[side_number(side, order_)].fill(missing == MissingSide::closed ? ~Row128{0} : 0);
}

template <class Row>
void VeilBorders::read_rows(Side& side, Direction direction, const RunChunk& neighbour,
                            const VisibilityTable& covers) {
  const auto axes = axes_of(order_);
  const Axis across = axis_of(direction);
  const Axis bits = axes[0] == across ? axes[1] : axes[0];
  const std::uint32_t depth = neighbour.extent.sides()[static_cast<std::size_t>(across)];
  std::array<Row, kRowBits<Row>> rows;
  read_opaque_layer(neighbour, {across, bits, is_positive(direction) ? 0 : depth - 1}, covers,
                    rows);
  std::copy_n(rows.begin(), std::min(rows.size(), side.size()), side.begin());
}

void VeilBorders::read(Direction side, const RunChunk& neighbour, const VisibilityTable& covers) {
  const auto own = extent_.sides(), beyond = neighbour.extent.sides();
  for (std::size_t axis = 0; axis < own.size(); ++axis)
    RUNSTONE_ASSERT(axis == static_cast<std::size_t>(axis_of(side)) || own[axis] == beyond[axis]);
  Side& rows = sides_[side_number(side, order_)];
  if (neighbour.is_uniform()) {
    rows.fill(covers[neighbour.runs.material(0)] == Visibility::opaque ? ~Row128{0} : 0);
  } else if (*std::max_element(beyond.begin(), beyond.end()) <= kRowBits<Row64>) {
    read_rows<Row64>(rows, side, neighbour, covers);
  } else {
    read_rows<Row128>(rows, side, neighbour, covers);
  }
}

}  // namespace runstone
