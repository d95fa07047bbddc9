// Shapes that are turned by quarter turns and mirrored, as a build is when it is placed.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/core/shape.hpp"

namespace runstone {

/// Returns the shape as it lies in the world. `along` are the axes of the shape in the order in
/// which they run along world x, y, z. Bits 0, 1, 2 of `flips`: that axis runs backwards along
/// world x, y, z. Boxes keep their order. Crossed planes stay upright: they keep their box if
/// another axis than y lies along world y. Requires a valid shape, and each axis once. Cost:
/// O(boxes).
Shape turned(const Shape& shape, std::array<Axis, 3> along, std::uint8_t flips);

/// Returns the shape turned by quarter turns about y: the side that lay north (-z) then lies east
/// (+x), after two turns south, and after three west.
Shape turned_about_y(const Shape& shape, unsigned quarters);

/// Returns true if two shapes look alike: their boxes fill the same cells, or they have the same
/// crossed planes. Their boxes may differ. Requires valid shapes. Cost: O(boxes), at most some
/// microseconds.
bool look_alike(const Shape& a, const Shape& b);

}  // namespace runstone
