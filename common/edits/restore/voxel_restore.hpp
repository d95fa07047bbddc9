// VoxelRestore: some voxels of a chunk without the effect of selected edits. It gives these voxels
// the materials that ChunkRestore gives them (restore.hpp has the rule and its proof), from two
// materials for each voxel instead of two chunks. So it serves selections that touch few voxels of
// very many chunks: no chunk is made, copied or compared. It works because the effect of an edit on
// a voxel depends on the descriptor and the present material of that voxel alone.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Voxels that follow the log. Thread: one.
class VoxelRestore {
 public:
  /// `before`: the materials of `voxels` before the first added edit. Requires that `voxels` ascend
  /// strictly, and as many materials.
  VoxelRestore(std::vector<VoxelPos> voxels, std::vector<Material> before);

  /// The materials at a moment of the log, to which later edits may return.
  struct Point {
    std::vector<Material> now, restored;
  };

  /// Adds the next edit of the log; edits that touch none of the voxels may be left out. Requires a
  /// valid edit. Cost: O(log voxels) for a single voxel; otherwise O(voxels between the sides of the
  /// edit along x), and for each voxel inside its bounding box that of touches(), or of
  /// apply_stack() for a paste.
  void add(const EditDescriptor& edit, bool is_selected, ApplyScratch& scratch);
  /// Returns the voxels as they are before the next edit. Cost: O(voxels).
  Point point(ApplyScratch&) const { return {now_, restored_}; }
  /// Adds the next edit, which is not selected and returns to `before`. Requires a point of these
  /// voxels. Cost: that of add().
  void add_return(const EditDescriptor& edit, const Point& before, ApplyScratch& scratch);

  /// Return the materials with all edits, and those without the tails, in the order of the voxels.
  std::span<const Material> now() const { return now_; }
  std::span<const Material> restored() const { return restored_; }
  /// Returns the number of voxels that differ between the two. Cost: O(voxels).
  std::uint64_t differences() const;

 private:
  /// Applies the edit to `now_`, and calls write(i) for each voxel that it changed.
  template <class Write>
  void apply(const EditDescriptor& edit, ApplyScratch& scratch, const Write& write);

  std::vector<VoxelPos> voxels_;
  std::vector<Material> now_, restored_;
};

}  // namespace runstone
