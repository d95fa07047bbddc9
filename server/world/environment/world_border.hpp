// The border of a world: the ground within which players may edit, a box or a circle of columns.
#pragma once
#include <cstdint>
#include <string>
#include <variant>

#include "common/core/coords.hpp"

namespace runstone {

/// The columns whose distance to the column in the middle is at most `radius` voxels, at all
/// heights.
struct BorderCircle {
  std::int32_t x = 0, z = 0;  // of the column in the middle
  std::int32_t radius = 1;    // 1 .. 2 * kWorldLimit
  friend bool operator==(const BorderCircle&, const BorderCircle&) = default;
};

using WorldBorder = std::variant<VoxelBox, BorderCircle>;

/// Returns true if the border leaves every height free.
inline bool has_all_heights(const VoxelBox& border) {
  return border.min.y <= -kWorldLimit && border.max.y >= kWorldLimit;
}

/// Returns true if the whole box lies within the border. Requires that the box is not empty and
/// lies in the world.
inline bool is_within(const WorldBorder& border, const VoxelBox& box) {
  if (const auto* bounds = std::get_if<VoxelBox>(&border)) return intersect(*bounds, box) == box;
  const auto& circle = std::get<BorderCircle>(border);
  // A circle is convex, so the columns at the corners suffice. The squares are below 2^62.
  const auto is_inside = [&](std::int32_t x, std::int32_t z) {
    const std::int64_t dx = std::int64_t{x} - circle.x, dz = std::int64_t{z} - circle.z;
    return dx * dx + dz * dz <= std::int64_t{circle.radius} * circle.radius;
  };
  const std::int32_t x = box.max.x - 1, z = box.max.z - 1;
  return is_inside(box.min.x, box.min.z) && is_inside(x, box.min.z) && is_inside(box.min.x, z) &&
         is_inside(x, z);
}

/// Returns true if a voxel of the world lies within the border.
inline bool holds_voxel(const WorldBorder& border, const VoxelPos& at) {
  return is_within(border, VoxelBox{at, {at.x + 1, at.y + 1, at.z + 1}});
}

/// Returns text such as "x -500 to 499, z -500 to 499", both included, or
/// "500 voxels around x 0, z 0". The heights are left out if all of them are inside.
inline std::string border_text(const WorldBorder& border) {
  if (const auto* circle = std::get_if<BorderCircle>(&border)) {
    return std::to_string(circle->radius) + " voxels around x " + std::to_string(circle->x) +
           ", z " + std::to_string(circle->z);
  }
  const auto& box = std::get<VoxelBox>(border);
  const auto range = [](const char* name, std::int32_t min, std::int32_t max) {
    return std::string(name) + " " + std::to_string(min) + " to " + std::to_string(max - 1);
  };
  std::string text = range("x", box.min.x, box.max.x) + ", ";
  if (!has_all_heights(box)) text += range("y", box.min.y, box.max.y) + ", ";
  return text + range("z", box.min.z, box.max.z);
}

/// Returns the border in the form for programs: "box X Z X Z" with the first column and the column
/// behind the last, or "circle X Z RADIUS".
inline std::string border_words(const WorldBorder& border) {
  const auto joined = [](const char* name, std::int32_t a, std::int32_t b, std::int32_t c) {
    return std::string(name) + " " + std::to_string(a) + " " + std::to_string(b) + " " +
           std::to_string(c);
  };
  if (const auto* circle = std::get_if<BorderCircle>(&border))
    return joined("circle", circle->x, circle->z, circle->radius);
  const auto& box = std::get<VoxelBox>(border);
  return joined("box", box.min.x, box.min.z, box.max.x) + " " + std::to_string(box.max.z);
}

}  // namespace runstone
