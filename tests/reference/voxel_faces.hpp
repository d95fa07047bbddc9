// Quads for the plain reference meshers, which write them to a list in the order of creation.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/mesh/quad.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone::reference {

/// Returns a rectangle of faces in one direction that starts at `at` and has `along_u` by `along_v`
/// faces.
constexpr Quad face_quad(LocalPos at, Direction direction, Material material,
                         std::uint32_t along_u = 1, std::uint32_t along_v = 1) {
  return pack({at.x, at.y, at.z, static_cast<std::uint8_t>(along_u),
               static_cast<std::uint8_t>(along_v), direction, material});
}

/// Returns a strip of `length` faces along `axis`, which is not the direction's.
constexpr Quad strip_quad(LocalPos at, Direction direction, Material material, Axis axis,
                          std::uint32_t length) {
  return u_axis_of(axis_of(direction)) == axis ? face_quad(at, direction, material, length, 1)
                                               : face_quad(at, direction, material, 1, length);
}

}  // namespace runstone::reference
