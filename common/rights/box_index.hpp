// BoxIndex: finds the boxes that overlap a given one. It holds a short list of new boxes, and
// packed trees of geometrically growing sizes (the logarithmic method of Bentley and Saxe 1980), so
// that one box more packs few boxes again. A tree is a binary tree of bounding boxes in preorder.
// Each node keeps the boxes that reach furthest along the axis by which its other boxes are parted.
// So a few large boxes do not widen the nodes of many small ones (as in the priority R-tree of
// Arge, de Berg, Haverkort and Yi 2004).
// Threads: one writer or several readers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/core/coords.hpp"

namespace runstone {

/// Returns true if the boxes have a voxel in common. Requires that neither is empty.
constexpr bool overlaps(const VoxelBox& a, const VoxelBox& b) {
  return (a.min.x < b.max.x) & (b.min.x < a.max.x) & (a.min.y < b.max.y) & (b.min.y < a.max.y) &
         (a.min.z < b.max.z) & (b.min.z < a.max.z);
}

class BoxIndex {
 public:
  using Id = std::uint32_t;

  /// Requires that the index has no such id, and that the box is not empty and lies in the world.
  /// Cost: O(log^2 n) on average over many changes; the costliest one is O(n log n).
  void insert(Id id, const VoxelBox& box);
  /// Requires that the index has the id. Cost: O(log n) on average over many changes; the costliest
  /// one is O(n log n).
  void remove(Id id);

  /// Calls visit(id) for each box that has a voxel in common with `box`, in no special order, until
  /// visit() returns false. Requires that `box` is not empty. Cost: O(log^2 n + found), if few
  /// boxes overlap one another.
  template <class F>
  void visit_overlapping(const VoxelBox& box, F&& visit) const;

  std::size_t size() const { return places_.size(); }

 private:
  // A removed entry of a tree keeps its place, with a box that overlaps none.
  struct Entry {
    VoxelBox box;
    Id id = 0;
  };
  struct Node {
    VoxelBox box;             // around all entries of the node and of those below it
    std::uint32_t next = 0;   // the node behind those below this one
    std::uint32_t entry = 0;  // the first entry of this node
    std::uint32_t entries_end = 0;
  };
  struct Tree {
    std::vector<Node> nodes;  // preorder
    std::vector<Entry> entries;
  };
  struct Place {
    std::uint32_t tree = 0;  // kRecent: in recent_
    std::uint32_t entry = 0;
  };
  static constexpr std::uint32_t kRecent = UINT32_MAX;
  static constexpr std::size_t kRecentMax = 16;
  static constexpr std::uint32_t kNodeEntries = 2;  // of a node that has nodes below it
  static constexpr std::uint32_t kLeafEntries = 8;  // at most
  // A tree is at least this many times as large as the next one. Fewer trees make a search faster,
  // and an insertion slower.
  static constexpr std::size_t kTreeGrowth = 4;

  /// Calls visit(id) for the entries that overlap the box. Returns false if visit() did.
  template <class F>
  static bool visit_entries(const Entry* first, const Entry* end, const VoxelBox& box, F& visit);
  static void build_nodes(Tree& tree, std::uint32_t first, std::uint32_t end);
  void pack_recent();
  void pack_all();
  void push_tree(std::vector<Entry> entries);

  std::vector<Tree> trees_;    // in the order of their sizes
  std::vector<Entry> recent_;  // at most kRecentMax
  std::unordered_map<Id, Place> places_;
  std::size_t removed_ = 0;  // entries of trees
};

template <class F>
bool BoxIndex::visit_entries(const Entry* first, const Entry* end, const VoxelBox& box, F& visit) {
  for (; first != end; ++first) {
    if (overlaps(first->box, box) && !visit(first->id)) return false;
  }
  return true;
}

template <class F>
void BoxIndex::visit_overlapping(const VoxelBox& box, F&& visit) const {
  if (!visit_entries(recent_.data(), recent_.data() + recent_.size(), box, visit)) return;
  for (const Tree& tree : trees_) {
    const Entry* entries = tree.entries.data();
    for (std::size_t i = 0; i < tree.nodes.size();) {
      const Node& node = tree.nodes[i];
      if (!overlaps(node.box, box)) {
        i = node.next;
        continue;
      }
      if (!visit_entries(entries + node.entry, entries + node.entries_end, box, visit)) return;
      ++i;
    }
  }
}

}  // namespace runstone
