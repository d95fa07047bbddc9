// OpenWinding: what the open edges of a mesh add to the generalised winding number. Internal to
// this room.
//
// The winding number of a point is the solid angle of the mesh seen from it, by 4 pi (Jacobson,
// Kavan, Sorkine-Hornung 2013). Strips from the open edges along the x axis close the mesh at
// infinity. The closed surface has a whole winding number: the signed crossings of a ray from the
// point against the x axis, which no strip crosses. So the winding number of the mesh is this
// count, plus the solid angles of the strips, and its cost depends on the open edges only, not on
// the triangles. (The same idea: Martens and Bessmeltsev 2025, one-shot winding numbers.)
//
// Far from the open edges the fraction of the sum changes little: its gradient is at most the sum
// of length / distance^2 of the edges, by 4 pi (law of Biot and Savart). So one value decides for a
// block of voxels, unless a half is within this bound; then the block is cut in two.
#pragma once
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/voxelise/mesh_edges.hpp"
#include "common/voxelise/model_placement.hpp"

namespace runstone {

/// A block of voxels, half-open, by axis.
struct VoxelBlock {
  std::array<std::int32_t, 3> low{}, high{};
};

class OpenWinding {
 public:
  /// The edges must outlive the object. `work_max`: fails after this many solid angles.
  OpenWinding(std::span<const MeshEdges::Open> edges, std::uint64_t work_max)
      : edges_(edges), work_max_(work_max) {}

  bool is_zero() const { return edges_.empty(); }

  /// Calls f(block, offset) for blocks that fill the given one. The winding number of the centre of
  /// a voxel is the signed crossings before it plus a number that is on the same side of each half
  /// as `offset`. A centre on a strip lies beside it, as half-open lines do (line_crossings.hpp).
  /// Returns false, perhaps after some calls, if the work is too much; then so does each later
  /// call. Thread: any.
  template <class F>
  bool decide(const VoxelBlock& block, F&& f) const {
    if (work_.fetch_add(edges_.size(), std::memory_order_relaxed) > work_max_) return false;
    const Answer answer = look_at(block);
    if (answer.offset) {
      f(block, *answer.offset);
      return true;
    }
    std::size_t axis = answer.first_axis;
    for (std::size_t i = axis + 1; i < 3; ++i) {
      if (block.high[i] - block.low[i] > block.high[axis] - block.low[axis]) axis = i;
    }
    VoxelBlock half = block;
    half.high[axis] = block.low[axis] + (block.high[axis] - block.low[axis]) / 2;
    if (!decide(half, f)) return false;
    half.low[axis] = half.high[axis];
    half.high[axis] = block.high[axis];
    return decide(half, f);
  }

 private:
  struct Answer {
    std::optional<double> offset;  // none: cut the block
    std::size_t first_axis = 0;    // among this axis and those behind it
  };
  Answer look_at(const VoxelBlock& block) const;

  std::span<const MeshEdges::Open> edges_;
  std::uint64_t work_max_;
  mutable std::atomic<std::uint64_t> work_{0};
};

}  // namespace runstone
