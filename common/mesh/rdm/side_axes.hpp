// Side axes: the axes of the six sides of a chunk as rows of bits, and of their quads, by axis
// order. Internal to rdm.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::rdm {

constexpr Direction direction_of(Axis axis, bool positive) {
  return static_cast<Direction>(static_cast<unsigned>(axis) * 2 + (positive ? 1 : 0));
}

/// Returns the voxels of the chunk along an axis.
inline std::uint32_t side_of(const RunChunk& chunk, Axis axis) {
  return chunk.extent.sides()[static_cast<std::size_t>(axis)];
}

/// A side as rows of bits: the axis across it, the axis along the bits, and the axis from row to
/// row.
struct SideAxes {
  Axis layer, bit, row;
};
/// Returns the axes of the slow, the middle and the fast sides.
constexpr std::array<SideAxes, 3> side_axes(AxisOrder order) {
  const auto axes = axes_of(order);
  return {{{axes[2], axes[0], axes[1]}, {axes[1], axes[0], axes[2]}, {axes[0], axes[1], axes[2]}}};
}

/// The quads of a side: the axis across it, the axis along their strips, and the axis along which
/// equal strips are joined.
struct StripAxes {
  Axis layer, strip, row;
};
/// Returns the axes of the slow, the middle and the fast sides.
constexpr std::array<StripAxes, 3> strip_axes(AxisOrder order) {
  const auto axes = axes_of(order);
  return {{{axes[2], axes[0], axes[1]}, {axes[1], axes[0], axes[2]}, {axes[0], axes[2], axes[1]}}};
}
/// Returns the axes of the sides across one axis.
constexpr StripAxes strip_axes(AxisOrder order, Axis layer) {
  const auto all = strip_axes(order);
  return *std::find_if(all.begin(), all.end(),
                       [layer](const StripAxes& s) { return s.layer == layer; });
}

}  // namespace runstone::rdm
