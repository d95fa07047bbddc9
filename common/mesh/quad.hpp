// Quad: one rectangle of equal faces in 8 bytes, which the GPU draws without unpacking on the CPU.
//   bits 0..6 x, 7..13 y, 14..20 z   voxel of the corner with the smallest coordinates (0..127)
//   bits 21..27 width - 1            faces along u
//   bits 28..34 height - 1           faces along v
//   bits 35..37 direction            core/coords.hpp
//   bits 38..53 material             u16
//   bits 54..63 face                 0: the faces fill a side of each voxel. Otherwise face - 1 is
//                                    that of the material's shape (common/shapes/shape_faces.hpp)
// (u, v) per axis are x: (y, z), y: (z, x), z: (x, y). u x v points along +axis (right-handed), so
// a positive face winds counter-clockwise over u, v seen from outside. Coordinates are local to the
// chunk.
#pragma once
#include <compare>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

struct QuadFields {
  std::uint8_t x = 0, y = 0, z = 0;
  std::uint8_t width = 1, height = 1;  // 1 .. 128
  Direction direction = Direction::neg_x;
  Material material = kEmpty;
  std::uint16_t face = 0;  // 0 .. kShapeFacesMax
  friend auto operator<=>(const QuadFields&, const QuadFields&) = default;
};

struct Quad {
  std::uint64_t bits = 0;
  friend auto operator<=>(const Quad&, const Quad&) = default;
};
static_assert(sizeof(Quad) == 8);

constexpr Axis u_axis_of(Axis axis) {
  return static_cast<Axis>((static_cast<unsigned>(axis) + 1) % 3);
}
constexpr Axis v_axis_of(Axis axis) {
  return static_cast<Axis>((static_cast<unsigned>(axis) + 2) % 3);
}

constexpr Quad pack(const QuadFields& q) {
  return {static_cast<std::uint64_t>(q.x) | static_cast<std::uint64_t>(q.y) << 7 |
          static_cast<std::uint64_t>(q.z) << 14 | static_cast<std::uint64_t>(q.width - 1) << 21 |
          static_cast<std::uint64_t>(q.height - 1) << 28 |
          static_cast<std::uint64_t>(q.direction) << 35 |
          static_cast<std::uint64_t>(q.material) << 38 | static_cast<std::uint64_t>(q.face) << 54};
}

constexpr QuadFields unpack(Quad quad) {
  const auto field = [bits = quad.bits](int shift, std::uint64_t mask) {
    return (bits >> shift) & mask;
  };
  return {
      static_cast<std::uint8_t>(field(0, 127)),      static_cast<std::uint8_t>(field(7, 127)),
      static_cast<std::uint8_t>(field(14, 127)),     static_cast<std::uint8_t>(field(21, 127) + 1),
      static_cast<std::uint8_t>(field(28, 127) + 1), static_cast<Direction>(field(35, 7)),
      static_cast<Material>(field(38, 65535)),       static_cast<std::uint16_t>(field(54, 1023))};
}

}  // namespace runstone
