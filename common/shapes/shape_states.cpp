#include "common/shapes/shape_states.hpp"

#include <algorithm>

#include "common/shapes/turned_shape.hpp"

namespace runstone {

std::string_view ShapeStates::get(std::string_view key, std::string_view otherwise) const {
  for (std::string_view left = states_; !left.empty();) {
    const std::size_t end = std::min(left.find(','), left.size());
    const std::string_view one = left.substr(0, end);
    if (one.size() > key.size() && one.starts_with(key) && one[key.size()] == '=')
      return one.substr(key.size() + 1);
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  return otherwise;
}

unsigned ShapeStates::number(std::string_view key, unsigned otherwise) const {
  const std::string_view text = get(key);
  if (text.empty() || text.size() > 3) return otherwise;
  unsigned out = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return otherwise;
    out = out * 10 + static_cast<unsigned>(c - '0');
  }
  return out;
}

std::string_view states_in_name(std::string_view material) {
  const std::size_t open = material.find('[');
  if (open == std::string_view::npos || material.back() != ']') return {};
  return material.substr(open + 1, material.size() - open - 2);
}

Shape shape_of_boxes(std::initializer_list<ShapeBox> boxes) { return {ShapeForm::boxes, boxes}; }

Shape with_boxes(Shape shape, const Shape& more) {
  shape.boxes.insert(shape.boxes.end(), more.boxes.begin(), more.boxes.end());
  return shape;
}

Shape upside_down(const Shape& shape) { return turned(shape, {Axis::x, Axis::y, Axis::z}, 2); }

Shape plant_shape(unsigned height, unsigned inset) {
  return {ShapeForm::crossed, {shape_box(inset, 0, inset, 16 - inset, height, 16 - inset)}};
}

unsigned quarters_of_facing(std::string_view facing) {
  return facing == "east" ? 1 : facing == "south" ? 2 : facing == "west" ? 3 : 0;
}

Shape faced(const Shape& north, std::string_view facing) {
  return turned_about_y(north, quarters_of_facing(facing));
}

Shape upended(const Shape& up, std::string_view facing) {
  if (facing == "up") return up;
  if (facing == "down") return upside_down(up);
  // The upper side then lies north.
  return faced(turned(up, {Axis::x, Axis::z, Axis::y}, 4), facing);
}

}  // namespace runstone
