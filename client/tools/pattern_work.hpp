// PatternWork: a pattern for boxes of the shown world that are too large to be worked out at once. It
// keeps the chunks as they were at the click, so that steps that come later read one and the same
// world. It never changes after it was made.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/replica/replica.hpp"
#include "client/tools/symmetry.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/patterns/bound_filter.hpp"
#include "common/patterns/bound_mix.hpp"
#include "common/patterns/replaced.hpp"
#include "common/sculpt/voxel_rows.hpp"

namespace runstone {

/// The units of work of one turn (Replacing::step()). They bound the time that a turn takes.
inline constexpr std::uint64_t kPatternTurnWork = std::uint64_t{1} << 18;

struct PatternWork {
  std::vector<VoxelBox> boxes;  // they do not overlap; at least one
  BoundMix mix;
  std::optional<BoundFilter> filter;
  VoxelRowsPtr only;  // the voxels of the boxes that count; null: all
  std::int32_t chunk_edge = 0;
  /// The chunks that meet the boxes, and those around them that were shown.
  std::map<ChunkCoord, ShownPtr> chunks;
  /// The copies besides the boxes themselves, and the materials by which they are mirrored.
  Symmetry symmetry;
  MaterialTable materials;
};
using PatternWorkPtr = std::shared_ptr<const PatternWork>;

/// Returns the work without copies. If `only` is not null, only its voxels change. Fails with words
/// for the player if a chunk of a box is not shown. Requires an open replica. Cost: O(chunks that
/// meet the boxes or lie around them).
Result<PatternWorkPtr, std::string> pattern_work(const Replica& replica,
                                                 std::vector<VoxelBox> boxes, BoundMix mix,
                                                 std::optional<BoundFilter> filter,
                                                 VoxelRowsPtr only = nullptr);

/// Returns the work with the copies of a symmetry. Fails with words for the player if a copy reaches
/// outside the world.
Result<PatternWorkPtr, std::string> with_symmetry(PatternWorkPtr work, const Symmetry& symmetry,
                                                  const MaterialTable& materials);

/// Returns the steps that replace in a part of a box. Fails as Replacing::of() does.
Result<Replacing> replacing_in(const PatternWorkPtr& work, const VoxelBox& part);

/// Returns the words for a failure of Replacing.
std::string pattern_failure(const Error& error);

}  // namespace runstone
