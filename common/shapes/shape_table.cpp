#include "common/shapes/shape_table.hpp"

#include <map>

namespace runstone {

ShapeTable::ShapeTable(std::span<const Shape> by_material) {
  std::map<Shape, std::uint16_t> different;
  for (const Shape& shape : by_material) {
    if (!shape.is_cube()) different.emplace(shape, std::uint16_t{0});
  }
  if (different.empty()) return;
  shapes_.reserve(different.size());
  for (auto& [shape, number] : different) {
    shapes_.push_back({shape, ShapeFaces(shape)});
    number = static_cast<std::uint16_t>(shapes_.size());
  }
  numbers_.reserve(by_material.size());
  for (const Shape& shape : by_material)
    numbers_.push_back(shape.is_cube() ? std::uint16_t{0} : different.at(shape));
}

}  // namespace runstone
