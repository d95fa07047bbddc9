#include "client/render/transparent_tree.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>
#include <utility>

#include "common/runs/extent.hpp"

namespace runstone {
namespace {

/// Places along an axis are in sixteenths of a voxel.
constexpr std::int32_t kUnits = kShapeUnits;

/// The box of a quad along the three axes, in sixteenths. It has no extent along the axis of its
/// direction unless it is a plane of a plant.
struct Rectangle {
  std::array<std::int32_t, 3> min{}, max{};
};

/// Returns the face of a shape that a quad stands for, or null for a side of whole voxels.
const ShapeFace* face_of(const QuadFields& quad, const ShapeTable& shapes) {
  if (quad.face == 0 || shapes.is_cube(quad.material)) return nullptr;
  const std::span<const ShapeFace> faces = shapes[quad.material].faces.faces();
  return quad.face <= faces.size() ? &faces[quad.face - 1U] : nullptr;
}

Rectangle rectangle_of(const QuadFields& quad, const ShapeTable& shapes) {
  const Axis axis = axis_of(quad.direction);
  const auto own = static_cast<std::size_t>(axis);
  const auto u = static_cast<std::size_t>(u_axis_of(axis));
  const auto v = static_cast<std::size_t>(v_axis_of(axis));
  Rectangle out;
  out.min = {quad.x * kUnits, quad.y * kUnits, quad.z * kUnits};
  out.max = out.min;
  if (const ShapeFace* face = face_of(quad, shapes)) {
    out.min[own] += std::min(face->depth, face->far_depth);
    out.max[own] += std::max(face->depth, face->far_depth);
    out.min[u] += face->u0;
    out.max[u] += (quad.width - 1) * kUnits + face->u1;
    out.min[v] += face->v0;
    out.max[v] += (quad.height - 1) * kUnits + face->v1;
    return out;
  }
  // Faces of positive directions lie at the far side of their voxel.
  if (is_positive(quad.direction)) out.min[own] = out.max[own] += kUnits;
  out.max[u] += quad.width * kUnits;
  out.max[v] += quad.height * kUnits;
  return out;
}

bool is_flat(const QuadFields& quad, const Rectangle& r) {
  const auto own = static_cast<std::size_t>(axis_of(quad.direction));
  return r.min[own] == r.max[own];
}

/// Cuts a quad between two voxels. Returns the parts below and above `voxel`. Requires that it has
/// voxels on both sides.
std::pair<QuadFields, QuadFields> cut(const QuadFields& quad, std::size_t axis,
                                      std::int32_t voxel) {
  QuadFields below = quad, above = quad;
  const bool is_along_u = static_cast<std::size_t>(u_axis_of(axis_of(quad.direction))) == axis;
  const std::array<std::uint8_t*, 3> place = {&above.x, &above.y, &above.z};
  const auto length = static_cast<std::uint8_t>(voxel - *place[axis]);
  (is_along_u ? below.width : below.height) = length;
  (is_along_u ? above.width : above.height) =
      static_cast<std::uint8_t>((is_along_u ? quad.width : quad.height) - length);
  *place[axis] = static_cast<std::uint8_t>(voxel);
  return {below, above};
}

struct Plane {
  std::size_t axis = 0;
  std::int32_t at = 0;
};

/// Counts the quads of a node by their places along one axis. Of the places only those with an
/// entry are visited, so that sixteenths do not cost more than whole voxels.
class PlaceCounts {
 public:
  struct Count {
    int begins = 0, ends = 0;
    int inside = 0;           // quads that lie in the plane
    bool is_between = false;  // the plane lies between two voxels, before a plant
  };
  /// `step`: all places are multiples of it.
  explicit PlaceCounts(std::int32_t step)
      : step_(step),
        counts_(static_cast<std::size_t>((std::int32_t{kSideMax} + 1) * kUnits / step + 1)),
        used_(counts_.size() / kWord + 1) {}

  Count& at(std::int32_t place) {
    const auto i = static_cast<std::size_t>(place / step_);
    used_[i / kWord] |= std::uint64_t{1} << (i % kWord);
    return counts_[i];
  }
  /// Calls f(place, count) for each place with an entry, ascending, and removes the entries.
  template <class F>
  void take_each(F&& f) {
    for (std::size_t word = 0; word < used_.size(); ++word) {
      for (std::uint64_t bits = std::exchange(used_[word], 0); bits != 0; bits &= bits - 1) {
        const std::size_t i = word * kWord + static_cast<std::size_t>(std::countr_zero(bits));
        f(static_cast<std::int32_t>(i) * step_, std::exchange(counts_[i], {}));
      }
    }
  }

 private:
  static constexpr std::size_t kWord = 64;
  std::int32_t step_;
  std::vector<Count> counts_;
  std::vector<std::uint64_t> used_;  // a bit for each of counts_
};

}  // namespace

/// What building a tree needs.
struct TransparentTree::Building {
  const ShapeTable& shapes;
  std::array<PlaceCounts, 3> counts;  // by axis; empty between two nodes

  Building(const ShapeTable& of_quads, std::int32_t step)
      : shapes(of_quads), counts{PlaceCounts(step), PlaceCounts(step), PlaceCounts(step)} {}

  /// Returns the plane that divides the fewest quads which cannot be cut there; of equal ones, that
  /// which cuts the fewest, and then that with the most equal sides. It is the plane of a quad, or
  /// a border between a plant and another quad. Returns nullopt if there is none: then all quads
  /// are planes of plants in one voxel. Requires quads.
  std::optional<Plane> best_plane(const std::vector<QuadFields>& quads) {
    for (const QuadFields& quad : quads) {
      const Rectangle r = rectangle_of(quad, shapes);
      const auto own = static_cast<std::size_t>(axis_of(quad.direction));
      const bool has_plane = is_flat(quad, r);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ++counts[axis].at(r.min[axis]).begins;
        ++counts[axis].at(r.max[axis]).ends;
        if (has_plane && axis == own) ++counts[axis].at(r.min[axis]).inside;
        if (!has_plane) counts[axis].at(r.min[axis] / kUnits * kUnits).is_between = true;
      }
    }
    constexpr std::int64_t kUncut = 1'000'000;  // above any cost without it
    const int total = static_cast<int>(quads.size());
    std::optional<Plane> best;
    std::int64_t best_cost = std::numeric_limits<std::int64_t>::max();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      int begun = 0, ended = 0;  // quads that begin below the plane, and that end below or at it
      counts[axis].take_each([&](std::int32_t at, const PlaceCounts::Count& count) {
        ended += count.ends;
        const int below = ended - count.inside;
        const int crossing = begun - below;
        const int above = total - below - crossing - count.inside;
        begun += count.begins;
        const bool divides = count.is_between && below > 0 && above > 0;
        if (count.inside == 0 && !divides) return;
        const std::int64_t cost =
            (at % kUnits == 0 ? 8 : kUncut) * crossing + std::abs(above - below);
        if (cost >= best_cost) return;
        best_cost = cost;
        best = Plane{axis, at};
      });
    }
    return best;
  }
};

std::optional<TransparentTree> TransparentTree::build(std::span<const Quad> quads,
                                                      const ShapeTable& shapes) {
  if (quads.size() > kQuadsMax) return std::nullopt;
  std::vector<QuadFields> fields;
  fields.reserve(quads.size());
  bool has_shapes = false;
  for (const Quad& quad : quads) {
    fields.push_back(unpack(quad));
    has_shapes = has_shapes || fields.back().face != 0;
  }
  Building building(shapes, has_shapes ? 1 : kUnits);
  TransparentTree out;
  out.root_ = out.add(std::move(fields), building);
  if (out.pieces_.size() > kPiecesMax) return std::nullopt;
  return out;
}

std::int32_t TransparentTree::add(std::vector<QuadFields> quads, Building& building) {
  if (quads.empty() || pieces_.size() > kPiecesMax) return kNone;
  const auto index = static_cast<std::int32_t>(nodes_.size());
  const std::optional<Plane> plane = building.best_plane(quads);
  Node node{0, 0, static_cast<std::uint32_t>(pieces_.size()), 0};
  if (!plane) {
    for (const QuadFields& quad : quads) pieces_.push_back(pack(quad));
    node.count = static_cast<std::uint32_t>(quads.size());
    nodes_.push_back(node);
    return index;
  }
  const auto [axis, at] = *plane;
  node.axis = axis;
  node.at = at;
  nodes_.push_back(node);
  std::vector<QuadFields> below, above;
  const std::int32_t voxel = at / kUnits;
  for (QuadFields quad : quads) {
    Rectangle r = rectangle_of(quad, building.shapes);
    if (r.min[axis] == at && r.max[axis] == at) {
      pieces_.push_back(pack(quad));
      continue;
    }
    // The voxels below and above the one that holds the plane are cut off.
    if (r.min[axis] < voxel * kUnits && r.max[axis] > at) {
      const auto [lower, rest] = cut(quad, axis, voxel);
      below.push_back(lower);
      quad = rest;
      r = rectangle_of(quad, building.shapes);
    }
    if (r.min[axis] < at && r.max[axis] > (voxel + 1) * kUnits) {
      const auto [rest, upper] = cut(quad, axis, voxel + 1);
      above.push_back(upper);
      quad = rest;
      r = rectangle_of(quad, building.shapes);
    }
    (r.min[axis] + r.max[axis] <= 2 * at ? below : above).push_back(quad);
  }
  quads = {};  // frees them before the sides are added
  node.count = static_cast<std::uint32_t>(pieces_.size()) - node.first;
  node.below = add(std::move(below), building);
  node.above = add(std::move(above), building);
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
  const bool is_above = eye[node.axis] * kUnits > node.at;
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
