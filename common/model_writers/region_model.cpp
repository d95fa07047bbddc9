#include "common/model_writers/region_model.hpp"

#include <algorithm>
#include <cstdlib>

namespace runstone {
namespace {

std::uint8_t layer_of(const QuadFields& q) {
  const std::array<std::uint8_t, 3> at = {q.x, q.y, q.z};
  return at[static_cast<std::size_t>(axis_of(q.direction))];
}

}  // namespace

void RegionModelMaker::begin_plane(const QuadFields& q) {
  plane_ = q;
  u_ = u_axis_of(axis_of(q.direction));
  v_ = v_axis_of(axis_of(q.direction));
  ++stamp_;  // at most the quads of a region
}

std::uint32_t RegionModelMaker::vertex_at(const Corner& at) {
  ModelPart& part = model_.parts.back();
  Slot& slot = slots_[static_cast<std::size_t>(at[static_cast<std::size_t>(v_)]) * kRegionPoints +
                      static_cast<std::size_t>(at[static_cast<std::size_t>(u_)])];
  if (is_welded_ && slot.stamp == stamp_) return slot.vertex;
  const auto vertex = static_cast<std::uint32_t>(part.vertex_count++);
  slot = {stamp_, vertex};
  model_.vertices.push_back({static_cast<std::uint8_t>(at[0]), static_cast<std::uint8_t>(at[1]),
                             static_cast<std::uint8_t>(at[2]), plane_.direction});
  return vertex;
}

void RegionModelMaker::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  model_.indices.insert(model_.indices.end(), {a, b, c});
  model_.parts.back().index_count += 3;
}

void RegionModelMaker::read_edge(const std::array<Corner, 4>& ring, std::size_t from,
                                 std::size_t to, const CornerGrid& corners, Edge& out) {
  out.assign(1, {ring_[from], 0});
  Corner at = ring[from];
  int length = 0;
  Corner step{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int distance = ring[to][axis] - at[axis];
    step[axis] = (distance > 0) - (distance < 0);
    length += std::abs(distance);
  }
  for (int i = 1; i < length; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] += step[axis];
    if (corners.has(at)) out.push_back({vertex_at(at), i});
  }
  out.push_back({ring_[to], length});
}

/// Fills a rectangle with triangles, so that each piece of an edge is the side of one triangle, and
/// no triangle lies on a line. The left edge becomes a fan around the second point of the lower
/// edge, and the right edge one around the last point but one of the upper edge. The rest lies
/// between two parallel lines.
void RegionModelMaker::fill_edges() {
  const std::uint32_t low = lower_[1].vertex;
  for (std::size_t i = 0; i + 1 < left_.size(); ++i)
    triangle(left_[i].vertex, left_[i + 1].vertex, low);
  const std::size_t last = upper_.size() - 2;
  std::size_t i = 1, j = 0;
  while (i + 1 < lower_.size() || j < last) {
    const bool takes_lower =
        j == last || (i + 1 < lower_.size() && lower_[i + 1].at <= upper_[j + 1].at);
    if (takes_lower) {
      triangle(lower_[i].vertex, lower_[i + 1].vertex, upper_[j].vertex);
      ++i;
    } else {
      triangle(lower_[i].vertex, upper_[j + 1].vertex, upper_[j].vertex);
      ++j;
    }
  }
  for (std::size_t k = 0; k + 1 < right_.size(); ++k)
    triangle(right_[k].vertex, right_[k + 1].vertex, upper_[last].vertex);
}

void RegionModelMaker::add_quad(Quad quad, const CornerGrid* corners) {
  const std::array<Corner, 4> ring = quad_corners(quad);
  for (std::size_t i = 0; i < 4; ++i) ring_[i] = vertex_at(ring[i]);
  if (corners != nullptr) {
    read_edge(ring, 0, 1, *corners, lower_);
    read_edge(ring, 1, 2, *corners, right_);
    read_edge(ring, 3, 2, *corners, upper_);
    read_edge(ring, 3, 0, *corners, left_);
    if (lower_.size() + right_.size() + upper_.size() + left_.size() > 8) {
      fill_edges();
      return;
    }
  }
  triangle(ring_[0], ring_[1], ring_[2]);
  triangle(ring_[0], ring_[2], ring_[3]);
}

const RegionModel& RegionModelMaker::make(VoxelPos origin, std::span<const Quad> quads,
                                          const CornerGrid* corners) {
  model_.origin = origin;
  model_.parts.clear();
  model_.vertices.clear();
  model_.indices.clear();
  std::fill(slots_.begin(), slots_.end(), Slot{});
  stamp_ = 0;
  for (const Quad quad : quads) {
    const QuadFields q = unpack(quad);
    const bool is_new_part = model_.parts.empty() || model_.parts.back().number != q.material;
    if (is_new_part)
      model_.parts.push_back({q.material, model_.vertices.size(), 0, model_.indices.size(), 0});
    if (is_new_part || q.direction != plane_.direction || layer_of(q) != layer_of(plane_))
      begin_plane(q);
    add_quad(quad, corners);
  }
  return model_;
}

}  // namespace runstone
