#include "common/runs/layer_diff.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

using Bits = std::bitset<kSideMax>;

/// Returns bits first .. last, both included.
Bits bit_range(std::uint32_t first, std::uint32_t last) {
  return (~Bits{} >> (kSideMax - 1 - (last - first))) << first;
}

/// Returns the places that a stretch touches on a ring of `size` places. The stretch begins at
/// place `first` and ends at place `last`, on the same or the next round. `full_turn`: the stretch
/// has at least `size` places.
Bits ring_range(std::uint32_t first, std::uint32_t last, std::uint32_t size, bool same_turn,
                bool full_turn) {
  if (full_turn) return bit_range(0, size - 1);
  if (same_turn) return bit_range(first, last);
  return bit_range(first, size - 1) | bit_range(0, last);
}

class SpanMarker {
 public:
  explicit SpanMarker(const RunChunk& shape)
      : extent_(ordered(shape.extent, shape.order)), axes_(axes_of(shape.order)) {}

  /// Marks voxels [begin, end) of the flattened chunk. Requires begin < end.
  void mark(std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t last = end - 1;
    const std::uint32_t count = end - begin;
    const std::uint32_t line_first = begin / extent_.f;
    const std::uint32_t line_last = last / extent_.f;
    const std::uint32_t slow_first = line_first / extent_.m;
    const std::uint32_t slow_last = line_last / extent_.m;
    dirty(2) |= bit_range(slow_first, slow_last);
    dirty(1) |= ring_range(line_first % extent_.m, line_last % extent_.m, extent_.m,
                           slow_first == slow_last, line_last - line_first + 1 >= extent_.m);
    dirty(0) |= ring_range(begin % extent_.f, last % extent_.f, extent_.f, line_first == line_last,
                           count >= extent_.f);
  }

  const DirtyLayers& result() const { return dirty_; }

 private:
  Bits& dirty(std::size_t rank) { return dirty_.layer[static_cast<std::size_t>(axes_[rank])]; }

  OrderedExtent extent_;
  std::array<Axis, 3> axes_;
  DirtyLayers dirty_;
};

template <class A, class B>
void walk(const A& a, const B& b, SpanMarker& marker) {
  std::size_t i = 0;
  std::size_t j = 0;
  std::uint32_t at = 0;
  // Start of the differing stretch [open, at) that is not yet marked.
  std::uint32_t open = 0;
  while (i < a.size() && j < b.size()) {
    const std::uint32_t end = std::min(a.end(i), b.end(j));
    if (a.material(i) == b.material(j)) {
      if (open < at) marker.mark(open, at);
      open = end;
    }
    at = end;
    if (a.end(i) == end) ++i;
    if (b.end(j) == end) ++j;
  }
  if (open < at) marker.mark(open, at);
}

}  // namespace

DirtyLayers all_layers(Extent extent) {
  DirtyLayers all;
  const auto sides = extent.sides();
  for (std::size_t axis = 0; axis < 3; ++axis) all.layer[axis] = bit_range(0, sides[axis] - 1U);
  return all;
}

DirtyLayers changed_layers(const RunChunk& before, const RunChunk& after) {
  RUNSTONE_ASSERT(before.extent == after.extent);
  if (before.order != after.order) {
    return digest_of(before) == digest_of(after) ? DirtyLayers{} : all_layers(after.extent);
  }
  SpanMarker marker(after);
  before.runs.visit(
      [&](const auto& a) { after.runs.visit([&](const auto& b) { walk(a, b, marker); }); });
  return marker.result();
}

bool border_dirty(const DirtyLayers& dirty, Direction d, unsigned side) {
  return dirty.layer[static_cast<std::size_t>(axis_of(d))].test(is_positive(d) ? side - 1 : 0);
}

}  // namespace runstone
