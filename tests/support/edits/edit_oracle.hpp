// The edit oracle: applies edits voxel by voxel to a dense chunk, straight from their definitions.
// It shares no code and no formula with common/edits. It also draws random edits around a chunk,
// for property tests and benchmarks.
#pragma once
#include <array>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "common/core/hash.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/support/runs/dense_chunk.hpp"

namespace runstone {

/// Prints "sphere (1,2,3) r 4 := 7 where = 2".
std::ostream& operator<<(std::ostream& out, const EditDescriptor& edit);

}  // namespace runstone

namespace runstone::test {

/// Mistakes that the oracle makes on request, so that a test can show that it detects them.
enum class OracleFault {
  none,
  thin_sphere,       // |d| <= r instead of |d| < r + 1/2
  thin_stroke,       // distance <= r instead of distance < r + 1/2
  unturned_paste,    // a paste's cells lie as in the clipboard
  early_mask,        // masks read the chunk before the stack
  lost_voxel,        // the last changed voxel keeps its old material
  miscounted_voxel,  // one changed voxel too many is reported
};

/// Returns what the geometry writes at this voxel, without the mask, or nullopt if the voxel is not
/// in it.
std::optional<Material> oracle_writes(const EditDescriptor& edit, VoxelPos at,
                                      OracleFault fault = OracleFault::none);

/// Returns true if the geometry contains this voxel.
bool oracle_covers(const EditDescriptor& edit, VoxelPos at, OracleFault fault = OracleFault::none);

struct OracleOutcome {
  std::uint64_t voxels_changed = 0;         // compared with the chunk before the whole stack
  std::array<std::set<unsigned>, 3> dirty;  // coordinates of changed voxels along x, y, z
};

/// Applies the edits one after another, each voxel by voxel, to the chunk whose first voxel is
/// `origin`.
OracleOutcome oracle_apply(DenseChunk& chunk, VoxelPos origin,
                           std::span<const EditDescriptor> edits,
                           OracleFault fault = OracleFault::none);

/// Returns the voxels of the geometry, found by trying every voxel up to `reach` away from
/// `around`.
std::vector<VoxelPos> oracle_voxels(const EditDescriptor& edit, VoxelPos around,
                                    std::int32_t reach);

/// Returns (first, before, after) of the groups of runs that differ between two run lists, by
/// comparing all runs.
std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> oracle_areas(
    const RunChunk& before, const RunChunk& after);

/// Returns the spans of an edit's geometry in a chunk, maximal and ascending, found voxel by voxel.
std::vector<IndexSpan> oracle_spans(const EditDescriptor& edit, VoxelPos origin, Extent extent,
                                    AxisOrder order);

/// Returns a clipboard with sides 1 .. side_max, mostly small, materials below `material_count`,
/// and any axis order.
std::shared_ptr<const Clipboard> random_clipboard(SplitMix64& rng, unsigned side_max,
                                                  unsigned material_count);

/// Returns one of all 48 orientations.
Orientation random_orientation(SplitMix64& rng);

/// Returns a stroke of few points that starts at `at` and stays within 33 voxels of it.
FillStroke random_stroke(SplitMix64& rng, VoxelPos at);

/// Returns a valid edit of any kind, mask and material near the chunk at `origin`: mostly inside,
/// often partly, sometimes wholly outside. Materials are 0 .. 7, so that masks match what earlier
/// edits wrote.
EditDescriptor random_edit_near(SplitMix64& rng, VoxelPos origin, Extent extent);

/// Returns any valid edit, with all fields over their whole range, extremes included.
EditDescriptor random_edit_anywhere(SplitMix64& rng);

}  // namespace runstone::test
