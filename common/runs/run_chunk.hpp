// RunChunk: the voxels of one chunk, kept as runs in index order. The one form for disk, memory, wire and
// mesh. Invariants (validate() checks them; the codec, the edits and the mesher rely on them):
//   - the extent is valid, the run list has the form its volume asks for, and there is at least one run;
//   - run ends ascend strictly and the last one is the volume, so the runs tile the chunk exactly;
//   - neighbouring runs differ in material, so equal voxels in equal axis order have equal runs (canonical).
// Threads: const access from anywhere; a mutable RunChunk belongs to one thread.
// Source: thesis 7.3 (runs over the flattened grid, crossing lines and layers).
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

/// Chunk of one material: a single run.
RunChunk uniform_chunk(Extent extent, Material material, AxisOrder order = AxisOrder::xyz);

/// Index of the run that covers `voxel`. Requires voxel < volume. O(log runs).
std::size_t find_run(const RunChunk& chunk, VoxelIndex voxel);

/// Material at a local position inside the extent. O(log runs).
Material material_at(const RunChunk& chunk, LocalPos at);

/// What fill() did to the run list: runs [first, first + before) became runs [first, first + after).
/// `first` is the edit index of the thesis, the runs replaced its edit area (7.3.3).
struct EditArea {
  std::uint32_t first = 0, before = 0, after = 0;
  friend bool operator==(const EditArea&, const EditArea&) = default;
};

/// Sets voxels [first, first + count) of the flattened chunk to `material`, splitting and merging runs.
/// Returns whether any voxel changed; then `area`, if given, says which runs were replaced.
/// Requires 0 < count and first + count <= volume. O(log runs + runs moved).
bool fill(RunChunk& chunk, VoxelIndex first, std::uint32_t count, Material material,
          EditArea* area = nullptr);

/// Names the first broken invariant; the offset is the run index. Bytes from outside pass here before use.
Result<void> validate(const RunChunk& chunk);
/// The same but for the extent, which may be that of a part: for runs that are no chunk (a clipboard's cells).
Result<void> validate_runs(const RunChunk& chunk);

/// Digest from scratch. A run is at most five boxes, or the difference of two prefix sums over whole layers,
/// whole lines and part of a line, as it is computed here: O(runs).
Digest digest_of(const RunChunk& chunk);

/// Digest of voxels [first, last) of the flattened chunk as if all were `material`. O(1).
/// Lets a digest follow an edit: new = old - span(old material) + span(new material).
Digest digest_of_span(const RunChunk& shape, VoxelIndex first, VoxelIndex last, Material material);

}  // namespace runstone
