#include "common/mesh/shapes/prepared_shapes.hpp"

namespace runstone::shape_mesh {
namespace {

/// Returns true if equal faces of two voxels side by side along the axis are one rectangle.
bool joins_along(const ShapeFace& face, Axis axis) {
  if (!face.is_flat()) return false;
  if (axis == u_axis_of(axis_of(face.direction))) return face.u0 == 0 && face.u1 == kShapeUnits;
  return axis == v_axis_of(axis_of(face.direction)) && face.v0 == 0 && face.v1 == kShapeUnits;
}

PreparedFace prepare_face(const ShapeFace& face, std::size_t number, AxisOrder order) {
  const JoinAxes axes = join_axes(order, face.direction);
  const bool joins_first = joins_along(face, axes.first);
  const bool joins_second = axes.has_second && joins_along(face, axes.second);
  PreparedFace out;
  out.bits = std::uint64_t{number + 1} << 54 | std::uint64_t{static_cast<std::uint8_t>(face.direction)} << 35;
  out.joins = static_cast<Joins>((joins_first ? kJoinsFirst : 0) | (joins_second ? kJoinsSecond : 0));
  out.joins_fast = joins_along(face, axes_of(order)[0]);
  out.number = static_cast<std::uint16_t>(number);
  return out;
}

bool covers(const SideMask& side, const ShapeFace& face) {
  for (std::size_t v = face.v0; v < face.v1; ++v) {
    for (std::size_t u = face.u0; u < face.u1; ++u) {
      if (!side[v * kShapeUnits + u]) return false;
    }
  }
  return true;
}

}  // namespace

void PreparedShapes::begin(const ShapeTable& shapes, AxisOrder order) {
  shapes_ = &shapes;
  order_ = order;
  index_.assign(shapes.shapes().size() + 1, 0);
  prepared_.clear();
  faces_.clear();
  memos_.fill({});
}

const PreparedShape& PreparedShapes::prepare(std::uint16_t number) {
  std::uint16_t& index = index_[number];
  if (index != 0) return prepared_[index - 1U];
  PreparedShape out;
  out.number = number;
  const std::span<const ShapeFace> faces = shapes_->shapes()[number - 1U].faces.faces();
  for (std::size_t i = 0, next = 0; i < kDirectionCount; ++i) {
    const std::size_t begin = next;
    while (next < faces.size() && faces[next].direction == static_cast<Direction>(i)) ++next;
    const auto append = [&](bool on_border) {
      for (std::size_t f = begin; f < next; ++f) {
        if (is_on_border(faces[f]) == on_border) faces_.push_back(prepare_face(faces[f], f, order_));
      }
      return static_cast<std::uint32_t>(faces_.size());
    };
    FacesOfDirection& of = out.faces[i];
    of.first = static_cast<std::uint32_t>(faces_.size());
    of.border = append(false);
    of.end = append(true);
  }
  prepared_.push_back(out);
  index = static_cast<std::uint16_t>(prepared_.size());
  return prepared_.back();
}

std::uint64_t PreparedShapes::cover(std::uint16_t own, std::uint16_t other, Direction d,
                                    std::uint32_t first, std::uint32_t end) const {
  const std::span<const ShapeFace> own_faces = shapes_->shapes()[own - 1U].faces.faces();
  const SideMask& side = shapes_->shapes()[other - 1U].faces.side(opposite(d));
  std::uint64_t out = 0;
  for (std::uint32_t i = first; i < end; ++i) {
    if (covers(side, own_faces[faces_[i].number])) out |= std::uint64_t{1} << (i - first);
  }
  return out;
}

}  // namespace runstone::shape_mesh
