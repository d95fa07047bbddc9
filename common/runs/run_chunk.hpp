// RunChunk: the voxels of one chunk, kept as runs in index order. Disk, memory, wire and mesher
// share this form. Invariants (validate() checks them; the codec, the edits and the mesher rely on
// them):
//   - the extent is valid, the run list has the form that its volume requires, and there is at
//     least one run;
//   - run ends ascend strictly and the last one is the volume, so the runs tile the chunk exactly;
//   - neighbouring runs differ in material, so equal voxels in equal axis order have equal runs
//     (canonical).
//
// Thread: const access from any thread; a mutable RunChunk belongs to one thread. Source: thesis
// 7.3 (runs over the flattened grid, crossing lines and layers).
#pragma once
#include <cstdint>

#include "common/core/digest.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/extent.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

struct RunChunk {
  Extent extent;
  AxisOrder order = AxisOrder::xyz;
  RunList runs;

  std::uint32_t volume() const { return extent.volume(); }
  bool is_uniform() const { return runs.size() == 1; }
  friend bool operator==(const RunChunk&, const RunChunk&) = default;
};

/// Returns a chunk of one material: a single run.
RunChunk uniform_chunk(Extent extent, Material material, AxisOrder order = AxisOrder::xyz);

/// Returns true if no voxel has a material.
inline bool is_empty(const RunChunk& chunk) {
  return chunk.is_uniform() && chunk.runs.material(0) == kEmpty;
}

/// Returns the index of the run that covers `voxel`. Requires voxel < volume. Cost: O(log runs).
std::size_t find_run(const RunChunk& chunk, VoxelIndex voxel);

/// Returns the material at a local position. Requires a position inside the extent. Cost: O(log
/// runs).
Material material_at(const RunChunk& chunk, LocalPos at);

/// The change that fill() made to the run list: runs [first, first + before) became runs [first,
/// first + after). `first` is the edit index of the thesis, and the replaced runs are its edit area
/// (7.3.3).
struct EditArea {
  std::uint32_t first = 0, before = 0, after = 0;
  friend bool operator==(const EditArea&, const EditArea&) = default;
};

/// Sets voxels [first, first + count) of the flattened chunk to `material`, splitting and merging
/// runs. Returns true if any voxel changed; then `area`, if given, names the replaced runs.
/// Requires 0 < count and first + count <= volume. Cost: O(log runs + runs moved).
bool fill(RunChunk& chunk, VoxelIndex first, std::uint32_t count, Material material,
          EditArea* area = nullptr);

/// Fails with the first broken invariant; the offset of the error is the run index. Bytes from
/// outside pass this check before use.
Result<void> validate(const RunChunk& chunk);
/// Checks the invariants of validate(), but allows the extent of a part. It is for runs that are no
/// chunk, such as the cells of a clipboard.
Result<void> validate_runs(const RunChunk& chunk);

/// Returns the digest, computed from all runs. The term of a run is the difference of two prefix
/// sums over whole layers, whole lines and part of a line. Cost: O(runs).
Digest digest_of(const RunChunk& chunk);

/// Returns the digest of voxels [first, last) of the flattened chunk as if all were `material`. It
/// serves to update a digest after an edit: new = old - span(old material) + span(new material).
/// Cost: O(1).
Digest digest_of_span(const RunChunk& shape, VoxelIndex first, VoxelIndex last, Material material);

}  // namespace runstone
