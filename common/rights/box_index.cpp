#include "common/rights/box_index.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kHighest = std::numeric_limits<std::int32_t>::max();
// It overlaps no box, and bounds() of it and another box is that other box.
constexpr VoxelBox kNoBox = {{kHighest, kHighest, kHighest}, {kLowest, kLowest, kLowest}};
constexpr std::array kAxes = {Axis::x, Axis::y, Axis::z};

std::int32_t along(VoxelPos p, Axis axis) {
  return axis == Axis::x ? p.x : axis == Axis::y ? p.y : p.z;
}

/// Returns twice the centre, which fits i32 within the world.
std::int32_t doubled_centre(const VoxelBox& box, Axis axis) {
  return along(box.min, axis) + along(box.max, axis);
}

VoxelBox bounds(const VoxelBox& a, const VoxelBox& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

/// Returns the axis along which the centres of the entries lie furthest apart.
template <class Entry>
Axis widest_axis(const Entry* first, const Entry* end) {
  Axis widest = Axis::x;
  std::int64_t widest_span = -1;
  for (const Axis axis : kAxes) {
    std::int64_t low = kHighest, high = kLowest;
    for (const Entry* entry = first; entry != end; ++entry) {
      const std::int64_t centre = doubled_centre(entry->box, axis);
      low = std::min(low, centre);
      high = std::max(high, centre);
    }
    if (high - low <= widest_span) continue;
    widest = axis;
    widest_span = high - low;
  }
  return widest;
}

}  // namespace

void BoxIndex::insert(Id id, const VoxelBox& box) {
  RUNSTONE_ASSERT(!box.empty());
  const auto slot = static_cast<std::uint32_t>(recent_.size());
  const bool is_new = places_.try_emplace(id, Place{kRecent, slot}).second;
  RUNSTONE_ASSERT(is_new);
  recent_.push_back({box, id});
  if (recent_.size() > kRecentMax) pack_recent();
}

void BoxIndex::remove(Id id) {
  const auto found = places_.find(id);
  RUNSTONE_ASSERT(found != places_.end());
  const Place place = found->second;
  places_.erase(found);
  if (place.tree == kRecent) {
    recent_[place.entry] = recent_.back();
    recent_.pop_back();
    if (place.entry < recent_.size()) places_[recent_[place.entry].id].entry = place.entry;
    return;
  }
  trees_[place.tree].entries[place.entry].box = kNoBox;
  ++removed_;
  if (removed_ > kRecentMax && removed_ > size()) pack_all();
}

/// Packs the recent boxes into a tree, together with the trees that are not much larger.
void BoxIndex::pack_recent() {
  std::vector<Entry> entries = std::exchange(recent_, {});
  while (!trees_.empty() && trees_.back().entries.size() < kTreeGrowth * entries.size()) {
    for (const Entry& entry : trees_.back().entries) {
      if (entry.box == kNoBox) {
        --removed_;
      } else {
        entries.push_back(entry);
      }
    }
    trees_.pop_back();
  }
  push_tree(std::move(entries));
}

void BoxIndex::pack_all() {
  std::vector<Entry> entries = std::exchange(recent_, {});
  for (const Tree& tree : trees_) {
    std::copy_if(tree.entries.begin(), tree.entries.end(), std::back_inserter(entries),
                 [](const Entry& entry) { return entry.box != kNoBox; });
  }
  trees_.clear();
  removed_ = 0;
  if (!entries.empty()) push_tree(std::move(entries));
}

void BoxIndex::push_tree(std::vector<Entry> entries) {
  const auto index = static_cast<std::uint32_t>(trees_.size());
  Tree& tree = trees_.emplace_back();
  tree.entries = std::move(entries);
  build_nodes(tree, 0, static_cast<std::uint32_t>(tree.entries.size()));
  for (std::size_t i = 0; i < tree.entries.size(); ++i) {
    places_[tree.entries[i].id] = {index, static_cast<std::uint32_t>(i)};
  }
}

/// Appends the nodes of the entries [first, end) and reorders these. The depth is O(log n), because
/// each step halves the entries.
void BoxIndex::build_nodes(Tree& tree, std::uint32_t first, std::uint32_t end) {
  const std::size_t at = tree.nodes.size();
  Node node{kNoBox, 0, first, end};
  for (std::uint32_t i = first; i < end; ++i) node.box = bounds(node.box, tree.entries[i].box);
  tree.nodes.push_back(node);
  if (end - first > kLeafEntries) {
    Entry* const entries = tree.entries.data();
    const Axis axis = widest_axis(entries + first, entries + end);
    const auto length = [axis](const Entry& entry) {
      return along(entry.box.max, axis) - along(entry.box.min, axis);
    };
    const std::uint32_t rest = first + kNodeEntries;
    std::nth_element(entries + first, entries + rest, entries + end,
                     [&](const Entry& a, const Entry& b) { return length(a) > length(b); });
    const std::uint32_t middle = rest + (end - rest) / 2;
    std::nth_element(entries + rest, entries + middle, entries + end,
                     [axis](const Entry& a, const Entry& b) {
                       return doubled_centre(a.box, axis) < doubled_centre(b.box, axis);
                     });
    tree.nodes[at].entries_end = rest;
    build_nodes(tree, rest, middle);
    build_nodes(tree, middle, end);
  }
  tree.nodes[at].next = static_cast<std::uint32_t>(tree.nodes.size());
}

}  // namespace runstone
