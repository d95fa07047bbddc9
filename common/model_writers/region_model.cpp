#include "common/model_writers/region_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace runstone {
namespace {

std::uint8_t layer_of(const QuadFields& q) {
  const std::array<std::uint8_t, 3> at = {q.x, q.y, q.z};
  return at[static_cast<std::size_t>(axis_of(q.direction))];
}

ModelNormal normal_of(Direction direction, const ShapeFace* face) {
  const auto sign = static_cast<std::int8_t>(is_positive(direction) ? 1 : -1);
  ModelNormal out{};
  out[static_cast<std::size_t>(axis_of(direction))] = sign;
  if (face == nullptr || face->is_flat()) return out;
  // A plane of a plant: upright, from (depth, v0) to (far_depth, v1) along x and z.
  const int x = face->far_depth - face->depth, z = face->v1 - face->v0;
  const int shared = std::gcd(x, z);
  out[0] = static_cast<std::int8_t>(sign * z / shared);
  out[2] = static_cast<std::int8_t>(-sign * x / shared);
  return out;
}

}  // namespace

std::array<double, 3> unit_normal(const ModelNormal& normal) {
  const double length =
      std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  return {normal[0] / length, normal[1] / length, normal[2] / length};
}

const ShapeFace* face_of(const QuadFields& q, const ShapeTable& shapes) {
  return q.face == 0 ? nullptr : &shapes[q.material].faces.faces()[q.face - 1U];
}

std::array<Corner, 4> quad_places(Quad quad, const ShapeFace* face) {
  std::array<Corner, 4> out = quad_corners(quad);
  for (Corner& corner : out) {
    for (int& place : corner) place *= kModelUnits;
  }
  if (face == nullptr) return out;
  const bool positive = is_positive(face->direction);
  const Axis axis = axis_of(face->direction);
  const auto w = static_cast<std::size_t>(axis);
  const auto u = static_cast<std::size_t>(u_axis_of(axis));
  const auto v = static_cast<std::size_t>(v_axis_of(axis));
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_far_u = i == 2 || i == (positive ? 1U : 3U);
    const bool is_far_v = i == 2 || i == (positive ? 3U : 1U);
    out[i][u] += is_far_u ? face->u1 - kModelUnits : face->u0;
    out[i][v] += is_far_v ? face->v1 - kModelUnits : face->v0;
    out[i][w] += (is_far_v ? face->far_depth : face->depth) - (positive ? kModelUnits : 0);
  }
  return out;
}

void RegionModelMaker::begin_plane(const QuadFields& q, const ShapeFace* face) {
  plane_ = q;
  u_ = u_axis_of(axis_of(q.direction));
  v_ = v_axis_of(axis_of(q.direction));
  normal_ = normal_of(q.direction, face);
  ++stamp_;  // at most the quads of a region
}

std::uint32_t RegionModelMaker::new_vertex(const Corner& at) {
  ModelPart& part = model_.parts.back();
  const auto place = [&](std::size_t axis) {
    if (at[axis] % kModelUnits != 0) model_.is_fine = true;
    return static_cast<std::uint16_t>(at[axis]);
  };
  model_.vertices.push_back({place(0), place(1), place(2), normal_});
  return static_cast<std::uint32_t>(part.vertex_count++);
}

std::uint32_t RegionModelMaker::vertex_at(const Corner& at) {
  if (!is_welded_) return new_vertex(at);
  const int u = at[static_cast<std::size_t>(u_)], v = at[static_cast<std::size_t>(v_)];
  if (plane_.face == 0 && u % kModelUnits == 0 && v % kModelUnits == 0) {
    Slot& slot = slots_[static_cast<std::size_t>(v / kModelUnits) * kRegionPoints +
                        static_cast<std::size_t>(u / kModelUnits)];
    if (slot.stamp != stamp_) slot = {stamp_, new_vertex(at)};
    return slot.vertex;
  }
  // 12 bits for each place, and 8 for each part of the normal.
  std::uint64_t key = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    key = key << 20 | static_cast<std::uint64_t>(at[i]) << 8 |
          static_cast<std::uint64_t>(static_cast<std::uint8_t>(normal_[i]));
  }
  const auto [known, is_new] = fine_.try_emplace(key, 0U);
  if (is_new) known->second = new_vertex(at);
  return known->second;
}

void RegionModelMaker::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  model_.indices.insert(model_.indices.end(), {a, b, c});
  model_.parts.back().index_count += 3;
}

void RegionModelMaker::read_edge(const std::array<Corner, 4>& ring, std::size_t from,
                                 std::size_t to, const CornerSet& corners, Edge& out) {
  const Corner &begin = ring[from], &end = ring[to];
  Corner step{};
  int length = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int distance = end[axis] - begin[axis];
    step[axis] = (distance > 0) - (distance < 0);
    length += std::abs(distance);
  }
  out.assign(1, {ring_[from], 0});
  corners.distances_between(begin, end, distances_);
  for (const int distance : distances_) {
    const auto place = [&](std::size_t axis) { return begin[axis] + step[axis] * distance; };
    out.push_back({vertex_at({place(0), place(1), place(2)}), distance});
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

void RegionModelMaker::add_quad(Quad quad, const ShapeFace* face, const CornerSet* corners) {
  const std::array<Corner, 4> ring = quad_places(quad, face);
  for (std::size_t i = 0; i < 4; ++i) ring_[i] = vertex_at(ring[i]);
  if (corners != nullptr && (face == nullptr || face->is_flat())) {
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
                                          const CornerSet* corners) {
  model_.origin = origin;
  model_.is_fine = false;
  model_.parts.clear();
  model_.vertices.clear();
  model_.indices.clear();
  std::fill(slots_.begin(), slots_.end(), Slot{});
  stamp_ = 0;
  for (const Quad quad : quads) {
    const QuadFields q = unpack(quad);
    const ShapeFace* const face = face_of(q, shapes_);
    const bool is_new_part = model_.parts.empty() || model_.parts.back().number != q.material;
    if (is_new_part) {
      model_.parts.push_back({q.material, model_.vertices.size(), 0, model_.indices.size(), 0});
      fine_.clear();
    }
    if (is_new_part || face != nullptr || q.direction != plane_.direction ||
        layer_of(q) != layer_of(plane_))
      begin_plane(q, face);
    add_quad(quad, face, corners);
  }
  return model_;
}

}  // namespace runstone
