// VoxelTree: a cube divided into eight parts, recursively, down to single voxels. Parts of one
// material are collapsed. Children are named by their slot in a pool, not by pointers. The lowest
// nodes hold the materials of 2 x 2 x 2 voxels. The pool's treatment of equal nodes makes two
// stores of it:
//   SparseOctree   every part has nodes of its own. Source: thesis 3.4; Laine, Karras 2010.
//   VoxelDag       equal parts share nodes; an edit makes new nodes along its path only. Source:
//                  Kämpe, Sintorn, Assarsson, "High Resolution Sparse Voxel DAGs" (2013); edits as
//                  in Careil et al. (2020).
// A tree is canonical: equal voxels have the same number of nodes, whatever edits came before.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "bench/storage/morton_array.hpp"
#include "bench/storage/shared_pool.hpp"
#include "bench/storage/slot_pool.hpp"
#include "bench/storage/voxel_store.hpp"

namespace runstone::bench::storage {

template <template <class> class Pool>
class VoxelTree {
 public:
  explicit VoxelTree(const RunChunk& chunk)
      : height_(static_cast<unsigned>(std::countr_zero(unsigned{chunk.extent.x}))) {
    root_ = build(in_morton_order(chunk));
    nodes_.shrink_to_fit();
    leaves_.shrink_to_fit();
  }

  Material at(LocalPos at) const {
    Part part = root_;
    for (unsigned bit = height_ - 1; !is_uniform(part); --bit) {
      if (is_leaf(part)) return leaves_[slot_of(part)][octant_of(at, 0)];
      part = nodes_[part][octant_of(at, bit)];
    }
    return material_of(part);
  }
  void set(LocalPos where, Material material) {
    if (at(where) != material) root_ = set(root_, height_, where, material);
  }
  void paint(const Ball& ball, Material material) {
    root_ = paint(root_, height_, {}, ball, material);
  }
  template <class F>
  void walk(F&& stretch) const {
    walk(root_, chunk_volume(), stretch);
  }
  std::size_t byte_size() const { return sizeof *this + nodes_.heap_size() + leaves_.heap_size(); }
  /// Returns the numbers of inner nodes and of leaves.
  std::array<std::size_t, 2> node_counts() const { return {nodes_.count(), leaves_.count()}; }

 private:
  /// A part of the cube: kUniform and its material, kLeaf and the slot of its leaf (2 x 2 x 2
  /// voxels), or the slot of its node. So equal parts of different heights may share a node. A
  /// function that takes a part in order to change it takes over the reference to its node, and
  /// returns one with its result.
  using Part = std::uint32_t;
  using Node = std::array<Part, 8>;
  using Leaf = std::array<Material, 8>;
  static constexpr Part kUniform = 1u << 31, kLeaf = 1u << 30;
  static constexpr Part uniform(Material material) { return kUniform | material; }
  static constexpr bool is_uniform(Part part) { return (part & kUniform) != 0; }
  static constexpr bool is_leaf(Part part) { return (part & kLeaf) != 0; }
  static constexpr std::uint32_t slot_of(Part leaf) { return leaf & ~kLeaf; }
  static constexpr Material material_of(Part part) { return static_cast<Material>(part); }
  static std::size_t octant_of(LocalPos at, unsigned bit) {
    return (at.x >> bit & 1u) | (at.y >> bit & 1u) << 1 | (at.z >> bit & 1u) << 2;
  }

  template <class T>
  static bool all_equal(const std::array<T, 8>& of) {
    return std::all_of(of.begin() + 1, of.end(), [&](T one) { return one == of[0]; });
  }

  Part close(const Leaf& voxels) {
    return all_equal(voxels) ? uniform(voxels[0]) : kLeaf | leaves_.add(voxels).first;
  }
  /// Makes a part from eight parts. Takes over the references to the children.
  Part close(const Node& parts) {
    if (is_uniform(parts[0]) && all_equal(parts)) return parts[0];
    const auto [slot, added] = nodes_.add(parts);
    if (!added) {
      for (const Part part : parts) drop(part);  // the existing node has its own references
    }
    return slot;
  }
  Leaf open_leaf(Part part) {
    Leaf out;
    if (is_uniform(part)) {
      out.fill(material_of(part));
      return out;
    }
    out = leaves_[slot_of(part)];
    leaves_.release(slot_of(part));
    return out;
  }
  Node open(Part part) {
    Node out;
    if (is_uniform(part)) {
      out.fill(part);
      return out;
    }
    out = nodes_[part];
    if (!nodes_.release(part)) share_all(out);
    return out;
  }
  void share_all(const Node& parts) {
    if constexpr (Pool<Node>::kShares) {
      for (const Part part : parts) {
        if (is_uniform(part)) continue;
        if (is_leaf(part)) {
          leaves_.share(slot_of(part));
        } else {
          nodes_.share(part);
        }
      }
    }
  }
  void drop(Part part) {
    if (is_uniform(part)) return;
    if (is_leaf(part)) {
      leaves_.release(slot_of(part));
      return;
    }
    const Node parts = nodes_[part];
    if (!nodes_.release(part)) return;
    for (const Part child : parts) drop(child);
  }

  /// Builds a part from voxels in Morton order.
  Part build(std::span<const Material> voxels) {
    if (voxels.size() == 8) {
      Leaf leaf;
      std::copy(voxels.begin(), voxels.end(), leaf.begin());
      return close(leaf);
    }
    Node parts;
    const std::size_t eighth = voxels.size() / 8;
    for (std::size_t octant = 0; octant < 8; ++octant) {
      parts[octant] = build(voxels.subspan(octant * eighth, eighth));
    }
    return close(parts);
  }

  Part set(Part part, unsigned height, LocalPos at, Material material) {
    const std::size_t octant = octant_of(at, height - 1);
    if (height == 1) {
      Leaf voxels = open_leaf(part);
      voxels[octant] = material;
      return close(voxels);
    }
    Node parts = open(part);
    parts[octant] = set(parts[octant], height - 1, at, material);
    return close(parts);
  }

  Part paint(Part part, unsigned height, LocalPos low, const Ball& ball, Material material) {
    if (part == uniform(material)) return part;
    switch (ball.against(low, 1 << height)) {
      case Ball::Against::apart:
        return part;
      case Ball::Against::covers:
        drop(part);
        return uniform(material);
      case Ball::Against::cuts:
        break;
    }
    const auto corner = [&](std::size_t octant) {
      const std::size_t half = std::size_t{1} << (height - 1);
      return LocalPos{static_cast<std::uint8_t>(low.x + (octant & 1) * half),
                      static_cast<std::uint8_t>(low.y + (octant >> 1 & 1) * half),
                      static_cast<std::uint8_t>(low.z + (octant >> 2 & 1) * half)};
    };
    if (height == 1) {
      Leaf voxels = open_leaf(part);
      for (std::size_t octant = 0; octant < 8; ++octant) {
        const LocalPos at = corner(octant);
        if (ball.contains(at.x, at.y, at.z)) voxels[octant] = material;
      }
      return close(voxels);
    }
    Node parts = open(part);
    for (std::size_t octant = 0; octant < 8; ++octant) {
      parts[octant] = paint(parts[octant], height - 1, corner(octant), ball, material);
    }
    return close(parts);
  }

  std::uint32_t chunk_volume() const { return std::uint32_t{1} << (3 * height_); }
  template <class F>
  void walk(Part part, std::uint32_t volume, F&& stretch) const {
    if (is_uniform(part)) {
      stretch(volume, material_of(part));
    } else if (is_leaf(part)) {
      for (const Material material : leaves_[slot_of(part)]) stretch(1u, material);
    } else {
      for (const Part child : nodes_[part]) walk(child, volume / 8, stretch);
    }
  }

  unsigned height_;  // the cube has 2^height_ voxels a side
  Part root_ = uniform(kEmpty);
  Pool<Node> nodes_;
  Pool<Leaf> leaves_;
};

using SparseOctree = VoxelTree<SlotPool>;
using VoxelDag = VoxelTree<SharedPool>;
static_assert(VoxelStore<SparseOctree> && VoxelStore<VoxelDag>);

}  // namespace runstone::bench::storage
