// Orientation: one of the 48 ways in which a clipboard can lie in the world: rotated by quarter
// turns about the axes and mirrored. Stored as one byte (docs/edit-log.md).
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "common/core/coords.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/extent.hpp"

namespace runstone {

struct Orientation {
  // The clipboard axes, in the order in which they run along world x, y, z.
  AxisOrder axes = AxisOrder::xyz;
  std::uint8_t flips = 0;  // bits 0, 1, 2: that axis runs backwards along world x, y, z
  friend bool operator==(const Orientation&, const Orientation&) = default;

  constexpr bool valid() const {
    return static_cast<std::uint8_t>(axes) < kAxisOrderCount && flips < 8;
  }

  /// Returns the clipboard axis along world axis `axis`.
  constexpr Axis along(Axis axis) const { return axes_of(axes)[static_cast<std::size_t>(axis)]; }
  constexpr bool flipped(Axis axis) const {
    return (flips >> static_cast<unsigned>(axis) & 1U) != 0;
  }

  /// Returns the sides in the world of a clipboard with these sides.
  constexpr Extent rotated(Extent clipboard) const {
    const auto sides = clipboard.sides();
    const auto side = [&](Axis axis) { return sides[static_cast<std::size_t>(along(axis))]; };
    return {side(Axis::x), side(Axis::y), side(Axis::z)};
  }

  /// Returns this orientation rotated by `quarters` quarter turns (any number) about the world's y
  /// axis. The sense is that in which a player's yaw grows: +z turns to +x, and +x turns to -z.
  constexpr Orientation rotated_about_y(int quarters) const;

  /// Returns this orientation mirrored along a world axis.
  constexpr Orientation mirrored(Axis axis) const {
    return {axes, static_cast<std::uint8_t>(flips ^ 1U << static_cast<unsigned>(axis))};
  }

  /// Returns 0 .. 47.
  constexpr std::uint8_t to_byte() const {
    return static_cast<std::uint8_t>(static_cast<unsigned>(axes) * 8 + flips);
  }
  /// Returns nullopt for bytes from 48 on.
  static constexpr std::optional<Orientation> of_byte(std::uint8_t byte) {
    if (byte >= kAxisOrderCount * 8) return std::nullopt;
    return Orientation{static_cast<AxisOrder>(byte / 8), static_cast<std::uint8_t>(byte % 8)};
  }
};

inline constexpr int kOrientationCount = kAxisOrderCount * 8;

constexpr Orientation Orientation::rotated_about_y(int quarters) const {
  // x and z swapped, by order number: xyz-zyx, xzy-yzx and yxz-zxy.
  constexpr std::array<AxisOrder, kAxisOrderCount> kSwapped = {AxisOrder::zyx, AxisOrder::yzx,
                                                               AxisOrder::zxy, AxisOrder::xzy,
                                                               AxisOrder::yxz, AxisOrder::xyz};
  Orientation out = *this;
  for (int i = (quarters % 4 + 4) % 4; i > 0; --i) {
    // The new x axis is the old z axis. The new z axis is the old x axis, reversed.
    const unsigned x = out.flips >> 2 & 1U, z = (out.flips & 1U) ^ 1U;
    out.axes = kSwapped[static_cast<std::size_t>(out.axes)];
    out.flips = static_cast<std::uint8_t>((out.flips & 2U) | x | z << 2);
  }
  return out;
}

}  // namespace runstone
