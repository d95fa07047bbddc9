#include "common/mesh/shapes/prepared_shapes.hpp"

#include <algorithm>

#include "common/mesh/rdm/side_axes.hpp"

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
  const auto joins =
      static_cast<Joins>((joins_first ? kJoinsFirst : 0) | (joins_second ? kJoinsSecond : 0));
  PreparedFace out;
  out.bits = std::uint64_t{number + 1} << 54 |
             std::uint64_t{static_cast<std::uint8_t>(face.direction)} << 35;
  out.list = static_cast<std::uint8_t>(list_of(face.direction, joins));
  out.joins_fast = joins_along(face, axes_of(order)[0]);
  if (out.joins_fast)
    out.size_shift = static_cast<std::uint8_t>(size_shift(face.direction, axes_of(order)[0]));
  out.number = static_cast<std::uint16_t>(number);
  return out;
}

}  // namespace

Sides sides_of(AxisOrder order) {
  Sides out{};
  const auto axes = axes_of(order);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = rdm::direction_of(axes[i / 2], i % 2 != 0);
  return out;
}

void PreparedShapes::begin(const ShapeTable& shapes, AxisOrder order) {
  shapes_ = &shapes;
  const bool is_bounded = faces_.size() <= kKeptFacesMax && others_.size() <= kKeptOthersMax;
  if (serial_ == shapes.serial() && order_ == order && is_bounded) return;
  serial_ = shapes.serial();
  order_ = order;
  sides_ = sides_of(order);
  index_.assign(shapes.shapes().size() + 1, 0);
  other_index_.assign(shapes.shapes().size() + 1, 0);
  prepared_.clear();
  others_.clear();
  faces_.clear();
  memos_.fill({});
}

const PreparedShape& PreparedShapes::append(std::uint16_t number) {
  PreparedShape out;
  out.number = number;
  out.first = static_cast<std::uint32_t>(faces_.size());
  const std::span<const ShapeFace> faces = shapes_->shapes()[number - 1U].faces.faces();
  const auto add = [&](std::size_t f) { faces_.push_back(prepare_face(faces[f], f, order_)); };
  std::array<std::size_t, kDirectionCount + 1> first{};  // of each direction: the faces ascend
  for (std::size_t i = 0, f = 0; i < kDirectionCount; ++i) {
    for (; f < faces.size() && faces[f].direction == static_cast<Direction>(i); ++f) {
      if (!is_on_border(faces[f])) add(f);
    }
    first[i + 1] = f;
  }
  out.inner = static_cast<std::uint16_t>(faces_.size() - out.first);
  for (std::size_t side = 0; side < sides_.size(); ++side) {
    const auto d = static_cast<std::size_t>(sides_[side]);
    const std::size_t before = faces_.size();
    for (std::size_t f = first[d]; f < first[d + 1]; ++f) {
      if (is_on_border(faces[f])) add(f);
    }
    out.border[side] = static_cast<std::uint16_t>(faces_.size() - before);
  }
  out.count = static_cast<std::uint32_t>(faces.size());
  std::array<std::uint32_t, kListCount> in_list{};
  for (std::size_t f = out.first; f < faces_.size(); ++f) ++in_list[faces_[f].list];
  out.most_in_list = *std::max_element(in_list.begin(), in_list.end());
  prepared_.push_back(out);
  index_[number] = static_cast<std::uint16_t>(prepared_.size());
  return prepared_.back();
}

const PreparedShapes::OtherShape& PreparedShapes::rows_of(std::uint16_t number) {
  std::uint16_t& index = other_index_[number];
  if (index != 0) return others_[index - 1U];
  OtherShape out;
  constexpr std::size_t kWordRows = 4;
  static const SideMask kWord(~std::uint64_t{0});
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const SideMask& side = shapes_->shapes()[number - 1U].faces.side(static_cast<Direction>(d));
    for (std::size_t v = 0; v < kShapeUnits; v += kWordRows) {
      const std::uint64_t word = (side >> v * kShapeUnits & kWord).to_ullong();
      for (std::size_t i = 0; i < kWordRows; ++i)
        out.sides[d][v + i] = static_cast<std::uint16_t>(word >> i * kShapeUnits);
    }
  }
  others_.push_back(out);
  index = static_cast<std::uint16_t>(others_.size());
  return others_.back();
}

std::uint64_t PreparedShapes::cover(std::uint16_t own, std::uint16_t other, Direction d,
                                    std::uint32_t first, std::uint32_t end) {
  const std::span<const ShapeFace> own_faces = shapes_->shapes()[own - 1U].faces.faces();
  const SideRows& rows = rows_of(other).sides[static_cast<std::size_t>(opposite(d))];
  std::uint64_t out = 0;
  for (std::uint32_t i = first; i < end; ++i) {
    const ShapeFace& face = own_faces[faces_[i].number];
    const unsigned bits = (1U << face.u1) - (1U << face.u0);
    unsigned filled = bits;
    for (std::size_t v = face.v0; v < face.v1; ++v) filled &= rows[v];
    if (filled == bits) out |= std::uint64_t{1} << (i - first);
  }
  return out;
}

}  // namespace runstone::shape_mesh
