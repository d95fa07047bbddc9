#include "common/shapes/shape_faces.hpp"

#include <bit>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::size_t kSide = kShapeUnits;

/// The cells of a layer of a voxel: bit u of row v.
using CellLayer = std::array<std::uint16_t, kSide>;
/// The cells of a voxel by their place along one axis.
using CellLayers = std::array<CellLayer, kSide>;

std::uint16_t bits_between(unsigned from, unsigned to) {
  return static_cast<std::uint16_t>((1U << to) - (1U << from));
}

/// Returns the cells that the boxes fill, in layers along the axis.
CellLayers layers_along(Axis axis, const Shape& shape) {
  const auto w = static_cast<std::size_t>(axis);
  const std::size_t u = (w + 1) % 3, v = (w + 2) % 3;
  CellLayers out{};
  for (const ShapeBox& box : shape.boxes) {
    const std::uint16_t bits = bits_between(box.min[u], box.max[u]);
    for (std::size_t depth = box.min[w]; depth < box.max[w]; ++depth) {
      for (std::size_t row = box.min[v]; row < box.max[v]; ++row)
        out[depth][row] = static_cast<std::uint16_t>(out[depth][row] | bits);
    }
  }
  return out;
}

/// Appends rectangles that cover the cells exactly once: each is as wide as it can be, then as
/// high.
void append_rectangles(CellLayer cells, Direction direction, std::uint8_t depth,
                       std::vector<ShapeFace>& out) {
  for (std::size_t v = 0; v < kSide; ++v) {
    while (cells[v] != 0) {
      const auto u0 = static_cast<unsigned>(std::countr_zero(cells[v]));
      const unsigned u1 =
          u0 + static_cast<unsigned>(std::countr_one(static_cast<std::uint16_t>(cells[v] >> u0)));
      const std::uint16_t bits = bits_between(u0, u1);
      std::size_t end = v;
      for (; end < kSide && (cells[end] & bits) == bits; ++end)
        cells[end] = static_cast<std::uint16_t>(cells[end] & ~bits);
      out.push_back({direction, depth, depth, static_cast<std::uint8_t>(u0),
                     static_cast<std::uint8_t>(u1), static_cast<std::uint8_t>(v),
                     static_cast<std::uint8_t>(end)});
    }
  }
}

/// Appends the faces of the cells that have no cell before them.
void append_surface(const CellLayers& layers, Direction direction, std::vector<ShapeFace>& out) {
  const bool positive = is_positive(direction);
  for (std::size_t depth = 0; depth < kSide; ++depth) {
    CellLayer exposed = layers[depth];
    const bool is_border = depth == (positive ? kSide - 1 : 0);
    if (!is_border) {
      const CellLayer& before = layers[positive ? depth + 1 : depth - 1];
      for (std::size_t v = 0; v < kSide; ++v)
        exposed[v] = static_cast<std::uint16_t>(exposed[v] & ~before[v]);
    }
    append_rectangles(exposed, direction, static_cast<std::uint8_t>(depth + (positive ? 1 : 0)),
                      out);
  }
}

SideMask mask_of(const CellLayer& layer) {
  SideMask out;
  for (std::size_t v = 0; v < kSide; ++v) {
    for (std::size_t u = 0; u < kSide; ++u) out[v * kSide + u] = (layer[v] >> u & 1) != 0;
  }
  return out;
}

}  // namespace

ShapeFaces::ShapeFaces(const Shape& shape) {
  RUNSTONE_ASSERT(!shape.is_cube());
  if (shape.form == ShapeForm::crossed) {
    for (const Direction d : {Direction::neg_x, Direction::pos_x}) {
      for (const auto& [min, max] : shape.boxes) {
        faces_.push_back({d, min[0], max[0], min[1], max[1], min[2], max[2]});
        faces_.push_back({d, max[0], min[0], min[1], max[1], min[2], max[2]});
      }
    }
    return;
  }
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    const CellLayers layers = layers_along(axis, shape);
    const auto negative = static_cast<std::size_t>(axis) * 2;
    append_surface(layers, static_cast<Direction>(negative), faces_);
    append_surface(layers, static_cast<Direction>(negative + 1), faces_);
    sides_[negative] = mask_of(layers.front());
    sides_[negative + 1] = mask_of(layers.back());
  }
}

unsigned filled_cells(const Shape& shape) {
  RUNSTONE_ASSERT(!shape.is_cube());
  if (shape.form == ShapeForm::crossed) return 0;
  unsigned out = 0;
  for (const CellLayer& layer : layers_along(Axis::x, shape)) {
    for (const std::uint16_t row : layer) out += static_cast<unsigned>(std::popcount(row));
  }
  return out;
}

Result<void> check_shape(const Shape& shape) {
  if (auto valid = validate_shape(shape); !valid) return valid;
  if (shape.is_cube()) return fail(ErrorCode::bad_value, "a shape has no box");
  if (ShapeFaces(shape).faces().size() > kShapeFacesMax) {
    return fail(ErrorCode::limit_exceeded, "a shape has more than 1023 faces; use fewer boxes",
                kShapeFacesMax);
  }
  return {};
}

bool is_on_border(const ShapeFace& face) {
  return face.is_flat() && face.depth == (is_positive(face.direction) ? kShapeUnits : 0);
}

}  // namespace runstone
