// AxisOrder: the order of the axes in which a chunk is flattened, fastest axis first. It decides
// how many runs a chunk needs (hills: 17,779 or 2,314). Each holder of a chunk chooses its own
// order: no log, commit or digest contains it. The index y + z*n + x*n^2 of the thesis, whose z is
// up, is zyx here.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/runs/extent.hpp"

namespace runstone {

/// Each order is named fastest axis first. The numbers break ties and are written to wire and disk.
enum class AxisOrder : std::uint8_t { xyz = 0, xzy = 1, yxz = 2, yzx = 3, zxy = 4, zyx = 5 };
inline constexpr int kAxisOrderCount = 6;
inline constexpr std::array<AxisOrder, kAxisOrderCount> kAxisOrders = {
    AxisOrder::xyz, AxisOrder::xzy, AxisOrder::yxz, AxisOrder::yzx, AxisOrder::zxy, AxisOrder::zyx};

/// Returns the axes of an order: [0] fastest, [1] middle, [2] slowest.
constexpr std::array<Axis, 3> axes_of(AxisOrder order) {
  constexpr std::array<std::array<Axis, 3>, kAxisOrderCount> kTable = {{
      {Axis::x, Axis::y, Axis::z},
      {Axis::x, Axis::z, Axis::y},
      {Axis::y, Axis::x, Axis::z},
      {Axis::y, Axis::z, Axis::x},
      {Axis::z, Axis::x, Axis::y},
      {Axis::z, Axis::y, Axis::x},
  }};
  return kTable[static_cast<std::size_t>(order)];
}

/// The extent of a chunk in its own order: f is fastest, m middle, s slowest. A line is f voxels; a
/// layer of the slowest axis is f * m voxels.
struct OrderedExtent {
  std::uint32_t f, m, s;
  constexpr std::uint32_t layer() const { return f * m; }
  constexpr std::uint32_t volume() const { return f * m * s; }
};

constexpr OrderedExtent ordered(Extent extent, AxisOrder order) {
  const auto sides = extent.sides();
  const auto axes = axes_of(order);
  return {sides[static_cast<std::size_t>(axes[0])], sides[static_cast<std::size_t>(axes[1])],
          sides[static_cast<std::size_t>(axes[2])]};
}

/// Coordinates along the fastest, middle and slowest axis.
struct OrderedPos {
  std::uint32_t f, m, s;
};

constexpr OrderedPos to_ordered(LocalPos p, AxisOrder order) {
  const std::array<std::uint32_t, 3> c = {p.x, p.y, p.z};
  const auto axes = axes_of(order);
  return {c[static_cast<std::size_t>(axes[0])], c[static_cast<std::size_t>(axes[1])],
          c[static_cast<std::size_t>(axes[2])]};
}

constexpr LocalPos from_ordered(OrderedPos p, AxisOrder order) {
  std::array<std::uint8_t, 3> c{};
  const auto axes = axes_of(order);
  c[static_cast<std::size_t>(axes[0])] = static_cast<std::uint8_t>(p.f);
  c[static_cast<std::size_t>(axes[1])] = static_cast<std::uint8_t>(p.m);
  c[static_cast<std::size_t>(axes[2])] = static_cast<std::uint8_t>(p.s);
  return {c[0], c[1], c[2]};
}

constexpr VoxelIndex index_of(LocalPos p, Extent extent, AxisOrder order) {
  const OrderedExtent e = ordered(extent, order);
  const OrderedPos o = to_ordered(p, order);
  return o.f + e.f * (o.m + e.m * o.s);
}

constexpr LocalPos pos_of(VoxelIndex index, Extent extent, AxisOrder order) {
  const OrderedExtent e = ordered(extent, order);
  return from_ordered({index % e.f, index / e.f % e.m, index / e.layer()}, order);
}

}  // namespace runstone
