// ShapeStates: the states of a material as its name has them in brackets, such as
// "facing=east,half=top", for the rules that make a shape of them.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "common/core/shape.hpp"

namespace runstone {

class ShapeStates {
 public:
  /// Keeps a view of the text. Text that is not well formed has no states.
  explicit ShapeStates(std::string_view states) : states_(states) {}
  /// Returns the value of a key, or `otherwise` if it is missing.
  std::string_view get(std::string_view key, std::string_view otherwise = {}) const;
  bool is(std::string_view key, std::string_view value) const { return get(key) == value; }
  bool is_true(std::string_view key) const { return get(key) == "true"; }
  /// Returns a decimal number of at most three digits, or `otherwise` if there is none.
  unsigned number(std::string_view key, unsigned otherwise) const;

 private:
  std::string_view states_;
};

/// Returns the states in the brackets of a material's name, "facing=east" of
/// "oak_stairs[facing=east]"; empty if there are none.
std::string_view states_in_name(std::string_view material);

/// Returns the shape of one box, in sixteenths from (x0, y0, z0) to (x1, y1, z1).
constexpr ShapeBox shape_box(unsigned x0, unsigned y0, unsigned z0, unsigned x1, unsigned y1,
                             unsigned z1) {
  const auto u = [](unsigned value) { return static_cast<std::uint8_t>(value); };
  return {{u(x0), u(y0), u(z0)}, {u(x1), u(y1), u(z1)}};
}

Shape shape_of_boxes(std::initializer_list<ShapeBox> boxes);

/// Returns the shape with the boxes of another one.
Shape with_boxes(Shape shape, const Shape& more);

/// Mirrors a shape along y.
Shape upside_down(const Shape& shape);

/// Returns a plant of this height, 1 .. 16, that keeps `inset` sixteenths from the voxel's sides.
Shape plant_shape(unsigned height, unsigned inset = 1);

/// Returns the number of quarter turns from north to a horizontal facing: east 1, south 2, west 3.
/// Other words are north.
unsigned quarters_of_facing(std::string_view facing);

/// Turns a shape that was made for facing=north.
Shape faced(const Shape& north, std::string_view facing);

/// Turns a shape that was made for facing=up, and that is symmetric about y, to any of the six.
Shape upended(const Shape& up, std::string_view facing);

}  // namespace runstone
