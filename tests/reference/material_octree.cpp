#include "tests/reference/material_octree.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/runs/dense.hpp"

namespace runstone::reference {
namespace {

constexpr VoxelPos child_of(VoxelPos at, std::int32_t half, std::uint32_t child) {
  return {at.x + ((child & 1) != 0 ? half : 0), at.y + ((child & 2) != 0 ? half : 0),
          at.z + ((child & 4) != 0 ? half : 0)};
}

/// Returns the index of a voxel in its brick. Coordinates are relative to the origin of the brick
/// or the tree.
constexpr std::size_t place_of(std::int32_t x, std::int32_t y, std::int32_t z) {
  constexpr std::int32_t kLow = MaterialOctree::kBrickSide - 1;
  return static_cast<std::size_t>((x & kLow) +
                                  MaterialOctree::kBrickSide *
                                      ((y & kLow) + MaterialOctree::kBrickSide * (z & kLow)));
}

}  // namespace

MaterialOctree::MaterialOctree(VoxelPos origin, unsigned depth)
    : origin_(origin), depth_(depth), nodes_(1) {
  RUNSTONE_ASSERT(depth <= kDepthMax);
}

MaterialOctree::Brick& MaterialOctree::brick_at(std::int32_t x, std::int32_t y, std::int32_t z) {
  std::uint32_t node = 0;
  for (std::int32_t half = side() / 2; half >= kBrickSide; half /= 2) {
    if (nodes_[node].children == 0) {
      const auto first = static_cast<std::uint32_t>(nodes_.size());
      const Material material = nodes_[node].material;
      nodes_[node].children = first;
      nodes_.resize(nodes_.size() + 8, Node{0, 0, material});
    }
    node = nodes_[node].children + ((x & half) != 0 ? 1u : 0u) + ((y & half) != 0 ? 2u : 0u) +
           ((z & half) != 0 ? 4u : 0u);
  }
  if (nodes_[node].brick == 0) {
    bricks_.emplace_back().fill(nodes_[node].material);
    nodes_[node].brick = static_cast<std::uint32_t>(bricks_.size());
  }
  return bricks_[nodes_[node].brick - 1];
}

void MaterialOctree::insert(VoxelPos first, const RunChunk& chunk) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
    const Run run = chunk.runs[i];
    for (; begin < run.end; ++begin) {
      const LocalPos local =
          from_ordered({begin % e.f, begin / e.f % e.m, begin / e.layer()}, chunk.order);
      const std::int32_t x = first.x - origin_.x + local.x;
      const std::int32_t y = first.y - origin_.y + local.y;
      const std::int32_t z = first.z - origin_.z + local.z;
      if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= side()) continue;
      brick_at(x, y, z)[place_of(x, y, z)] = run.material;
    }
  }
}

void MaterialOctree::compact() {
  MaterialOctree out(origin_, depth_);
  compact(0, out, 0);
  *this = std::move(out);
}

/// Copies a node and the nodes below it to node `to` of another tree. Returns true if it is of one
/// material.
bool MaterialOctree::compact(std::uint32_t node, MaterialOctree& into, std::uint32_t to) const {
  const Node& from = nodes_[node];
  if (from.brick != 0) {
    const Brick& brick = bricks_[from.brick - 1];
    const bool uniform =
        std::all_of(brick.begin(), brick.end(), [&](Material m) { return m == brick[0]; });
    if (uniform) {
      into.nodes_[to].material = brick[0];
    } else {
      into.bricks_.push_back(brick);
      into.nodes_[to].brick = static_cast<std::uint32_t>(into.bricks_.size());
    }
    return uniform;
  }
  if (from.children == 0) {
    into.nodes_[to].material = from.material;
    return true;
  }
  const auto first = static_cast<std::uint32_t>(into.nodes_.size());
  into.nodes_.resize(into.nodes_.size() + 8);
  bool uniform = true;
  for (std::uint32_t child = 0; child < 8; ++child) {
    const bool one = compact(from.children + child, into, first + child);
    uniform = uniform && one && into.nodes_[first + child].material == into.nodes_[first].material;
  }
  if (!uniform) {
    into.nodes_[to].children = first;
    return false;
  }
  into.nodes_[to].material = into.nodes_[first].material;
  into.nodes_.resize(first);  // nothing was added behind the eight, since they are uniform
  return true;
}

void MaterialOctree::sample(VoxelPos first, DenseGrid& grid) const {
  RUNSTONE_ASSERT(grid.order() == AxisOrder::xyz);
  count_dense_expansion();
  const OrderedExtent e = grid.sides();
  const VoxelPos low = {first.x - origin_.x, first.y - origin_.y,
                        first.z - origin_.z};  // origin of the grid, in the tree
  const VoxelBox wanted = {
      {low.x - 1, low.y - 1, low.z - 1},
      {low.x + static_cast<std::int32_t>(e.f) + 1, low.y + static_cast<std::int32_t>(e.m) + 1,
       low.z + static_cast<std::int32_t>(e.s) + 1}};
  const VoxelBox cube = {{0, 0, 0}, {side(), side(), side()}};
  if (intersect(wanted, cube) != wanted) {  // a part of it lies outside
    for (std::ptrdiff_t s = -1; s <= static_cast<std::ptrdiff_t>(e.s); ++s) {
      for (std::ptrdiff_t m = -1; m <= static_cast<std::ptrdiff_t>(e.m); ++m) {
        std::fill_n(grid.line(m, s) - 1, e.f + 2, kEmpty);
      }
    }
  }
  sample(nodes_[0], {0, 0, 0}, side(), wanted, grid);
}

void MaterialOctree::sample(const Node& node, VoxelPos at, std::int32_t side,
                            const VoxelBox& wanted, DenseGrid& grid) const {
  const VoxelBox part = intersect({at, {at.x + side, at.y + side, at.z + side}}, wanted);
  if (part.empty()) return;
  if (node.children != 0) {
    for (std::uint32_t child = 0; child < 8; ++child) {
      sample(nodes_[node.children + child], child_of(at, side / 2, child), side / 2, wanted, grid);
    }
    return;
  }
  const auto length = static_cast<std::size_t>(part.max.x - part.min.x);
  for (std::int32_t z = part.min.z; z < part.max.z; ++z) {
    for (std::int32_t y = part.min.y; y < part.max.y; ++y) {
      Material* const to =
          grid.line(y - wanted.min.y - 1, z - wanted.min.z - 1) + (part.min.x - wanted.min.x - 1);
      if (node.brick != 0) {
        std::copy_n(bricks_[node.brick - 1].data() + place_of(part.min.x, y, z), length, to);
      } else {
        std::fill_n(to, length, node.material);
      }
    }
  }
}

}  // namespace runstone::reference
