#include "client/render/transparent_tree.hpp"

#include <cstdlib>
#include <utility>

#include "common/runs/extent.hpp"

namespace runstone {
namespace {

/// A rectangle of a quad along the three axes. It has no extent along the axis of its direction.
struct Rectangle {
  std::array<std::int32_t, 3> min{}, max{};
};

Rectangle rectangle_of(const QuadFields& quad) {
  const Axis axis = axis_of(quad.direction);
  Rectangle out;
  out.min = {quad.x, quad.y, quad.z};
  // Faces of positive directions lie at the far side of their voxel.
  if (is_positive(quad.direction)) ++out.min[static_cast<std::size_t>(axis)];
  out.max = out.min;
  out.max[static_cast<std::size_t>(u_axis_of(axis))] += quad.width;
  out.max[static_cast<std::size_t>(v_axis_of(axis))] += quad.height;
  return out;
}

/// Cuts a quad at a plane that crosses it. Returns the parts below and above the plane.
std::pair<QuadFields, QuadFields> cut(const QuadFields& quad, std::size_t axis, std::int32_t at) {
  QuadFields below = quad, above = quad;
  const bool is_along_u = static_cast<std::size_t>(u_axis_of(axis_of(quad.direction))) == axis;
  const std::array<std::uint8_t*, 3> place = {&above.x, &above.y, &above.z};
  const auto length = static_cast<std::uint8_t>(at - *place[axis]);
  (is_along_u ? below.width : below.height) = length;
  (is_along_u ? above.width : above.height) =
      static_cast<std::uint8_t>((is_along_u ? quad.width : quad.height) - length);
  *place[axis] = static_cast<std::uint8_t>(at);
  return {below, above};
}

struct Plane {
  std::size_t axis = 0;
  std::int32_t at = 0;
};

/// Returns the plane of a quad that cuts the fewest others; of equal ones, that with the most equal
/// sides. Requires quads.
Plane best_plane(const std::vector<QuadFields>& quads) {
  constexpr std::size_t kPlanes = kSideMax + 2;
  struct Count {
    int inside = 0, begins = 0, ends = 0;
  };
  std::array<std::array<Count, kPlanes>, 3> counts{};
  for (const QuadFields& quad : quads) {
    const Rectangle r = rectangle_of(quad);
    const auto own = static_cast<std::size_t>(axis_of(quad.direction));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto& of_axis = counts[axis];
      if (axis == own) ++of_axis[static_cast<std::size_t>(r.min[axis])].inside;
      ++of_axis[static_cast<std::size_t>(r.min[axis])].begins;
      ++of_axis[static_cast<std::size_t>(r.max[axis])].ends;
    }
  }
  const int total = static_cast<int>(quads.size());
  Plane best;
  int best_cost = -1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    int begun = 0, ended = 0;  // quads that begin below the plane, and that end below or at it
    for (std::size_t at = 0; at < kPlanes; ++at) {
      const Count& count = counts[axis][at];
      ended += count.ends;
      if (count.inside != 0) {
        const int below = ended - count.inside;
        const int crossing = begun - below;
        const int above = total - below - crossing - count.inside;
        const int cost = 8 * crossing + std::abs(above - below);
        if (best_cost < 0 || cost < best_cost) {
          best_cost = cost;
          best = {axis, static_cast<std::int32_t>(at)};
        }
      }
      begun += count.begins;
    }
  }
  return best;
}

}  // namespace

std::optional<TransparentTree> TransparentTree::build(std::span<const Quad> quads) {
  if (quads.size() > kQuadsMax) return std::nullopt;
  std::vector<QuadFields> fields;
  fields.reserve(quads.size());
  for (const Quad& quad : quads) fields.push_back(unpack(quad));
  TransparentTree out;
  out.root_ = out.add(std::move(fields));
  if (out.pieces_.size() > kPiecesMax) return std::nullopt;
  return out;
}

std::int32_t TransparentTree::add(std::vector<QuadFields> quads) {
  if (quads.empty() || pieces_.size() > kPiecesMax) return kNone;
  const Plane plane = best_plane(quads);
  const auto index = static_cast<std::int32_t>(nodes_.size());
  nodes_.push_back({plane.axis, plane.at, static_cast<std::uint32_t>(pieces_.size()), 0});
  std::vector<QuadFields> below, above;
  for (const QuadFields& quad : quads) {
    const Rectangle r = rectangle_of(quad);
    const std::int32_t min = r.min[plane.axis], max = r.max[plane.axis];
    if (min == plane.at && max == plane.at) {
      pieces_.push_back(pack(quad));
    } else if (max <= plane.at) {
      below.push_back(quad);
    } else if (min >= plane.at) {
      above.push_back(quad);
    } else {
      const auto [lower, upper] = cut(quad, plane.axis, plane.at);
      below.push_back(lower);
      above.push_back(upper);
    }
  }
  quads = {};  // frees them before the sides are added
  Node node = nodes_[static_cast<std::size_t>(index)];
  node.count = static_cast<std::uint32_t>(pieces_.size()) - node.first;
  node.below = add(std::move(below));
  node.above = add(std::move(above));
  nodes_[static_cast<std::size_t>(index)] = node;
  return index;
}

void TransparentTree::append_back_to_front(const std::array<double, 3>& eye, std::uint32_t first,
                                           std::vector<QuadSpan>& out) const {
  append(root_, eye, first, out);
}

void TransparentTree::append(std::int32_t index, const std::array<double, 3>& eye,
                             std::uint32_t first, std::vector<QuadSpan>& out) const {
  if (index == kNone) return;
  const Node& node = nodes_[static_cast<std::size_t>(index)];
  const bool is_above = eye[node.axis] > node.at;
  append(is_above ? node.below : node.above, eye, first, out);
  const std::uint32_t begin = first + node.first;
  if (!out.empty() && out.back().first + out.back().count == begin) {
    out.back().count += node.count;
  } else {
    out.push_back({begin, node.count});
  }
  append(is_above ? node.above : node.below, eye, first, out);
}

}  // namespace runstone
