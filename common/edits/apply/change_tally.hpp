// ChangeTally: collects what follows from the changed stretches of a chunk:
//   - the list of changes;
//   - the difference of the digest;
//   - the layers to mesh again;
//   - the number of voxels.
//
// Each stretch costs O(1), even if it crosses many lines. Internal to edits.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/digest.hpp"
#include "common/core/m61.hpp"
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/line_bits.hpp"
#include "common/runs/line_digest.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

class ChangeTally {
 public:
  enum class Want : std::uint8_t {
    everything,
    changes,  // the list alone; digest, layers and number stay 0
  };

  /// Only extent and order of `shape` are used. Appends to `changes`. Requires that `changes` is
  /// empty.
  ChangeTally(const RunChunk& shape, std::vector<Change>& changes, MaterialFactors& factors,
              Want want = Want::everything);

  /// Adds a stretch: the voxels [first, last), which all were `before`, became `after`. Requires
  /// `before` != `after`, and stretches that ascend and do not overlap.
  void stretch(VoxelIndex first, VoxelIndex last, Material before, Material after) {
    note(first, last, after);
    if (want_ == Want::changes) return;
    voxels_ += last - first;
    if (first >= line_end_) open_line(first);
    if (last <= line_end_) {
      in_line(first - line_begin_, last - line_begin_, before, after);
    } else {
      across_lines(first, last, before, after);
    }
  }

  /// Adds all changes of line m of layer s. `changed` marks the changed voxels. `cuts` marks the
  /// voxels where a stretch must end, because `before` or `after` differs from the previous voxel.
  /// Requires ascending lines. Cost: O(stretches).
  void line(std::uint32_t m, std::uint32_t s, LineBits changed, LineBits cuts,
            const Material* before, const Material* after);

  /// Call it once, after the last stretch.
  void finish();
  Digest digest_difference() const { return digest_; }  // modulo the digest's prime
  DirtyLayers dirty() const;
  std::uint64_t voxels() const { return voxels_; }

 private:
  void open_line(VoxelIndex first);
  void close_line();
  void close_layer();
  void note(VoxelIndex first, VoxelIndex last, Material after) {
    if (!changes_.empty() && changes_.back().last == first && changes_.back().material == after) {
      changes_.back().last = last;
    } else {
      changes_.push_back({first, last, after});
    }
  }
  /// Notes the stretches of a line, as line() does.
  void note_line(VoxelIndex begin, LineBits changed, LineBits cuts, const Material* after);
  /// Returns the factor of one place along the axis of this rank: 0 for f, 1 for m, 2 for s.
  std::uint64_t factor_at(std::size_t lane, std::size_t rank, std::uint32_t i) const {
    return m61::sub(prefixes_[rank][lane][i + 1], prefixes_[rank][lane][i]);
  }
  void in_line(std::uint32_t first, std::uint32_t last, Material before, Material after);
  void across_lines(VoxelIndex first, VoxelIndex last, Material before, Material after);

  const Want want_;
  const RunChunk& shape_;
  const OrderedExtent extent_;
  using Prefixes = std::array<const std::uint64_t*, kDigestLanes>;
  std::array<Prefixes, 3> prefixes_;  // of the places along f, m and s
  std::vector<Change>& changes_;
  MaterialFactors& factors_;
  VoxelIndex line_begin_ = 0, line_end_ = 0;  // the line in which the last stretch began
  LineDigest line_digest_;                    // of that line's stretches
  std::uint32_t layer_ = 0;                   // of the last call of line()
  std::array<std::uint64_t, kDigestLanes> layer_sum_{};
  std::array<LineBits, 3> dirty_{};  // by f, m, s
  Digest digest_;
  std::uint64_t voxels_ = 0;
};

}  // namespace runstone
