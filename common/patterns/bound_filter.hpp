// BoundFilter: a filter with the materials of a world. It works on the runs of a column and its
// four neighbours; only `noise` takes the voxels one by one. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/patterns/clump_noise.hpp"
#include "common/patterns/height_ranges.hpp"
#include "common/patterns/pattern.hpp"
#include "common/sculpt/ground_columns.hpp"

namespace runstone {

class BoundFilter {
 public:
  /// A name stands for the material that find_material() finds and for those of its family: `is
  /// chest` holds for a chest in any state. Fails for a name that the world lacks.
  static Result<BoundFilter, PatternError> of(const VoxelFilter& filter, const MaterialTable& table,
                                              std::uint64_t seed);

  /// Returns true if the answer for a voxel depends on voxels beside, below or above it.
  bool reads_neighbours() const;
  /// Returns the voxels of a column in `range` for which the filter holds. A neighbour outside the
  /// box of the columns, or in a column that was not read, matches nothing. Requires a column that
  /// was read, and a range inside the box. Cost: O(conditions * runs of five columns), and
  /// O(voxels) for `noise`.
  HeightRanges passing(const GroundColumns& columns, std::int32_t x, std::int32_t z,
                       HeightRange range);
  /// Returns the number of conditions that it checks, with those that hold them together. Cost:
  /// O(conditions).
  std::uint64_t conditions() const;
  /// Returns the number of voxels that `noise` has taken one by one.
  std::uint64_t noise_voxels() const;

 private:
  struct Column {
    const GroundColumns& columns;
    std::int32_t x = 0, z = 0;
  };
  std::optional<PatternError> bind(const VoxelFilter& filter, const MaterialTable& table,
                                   std::uint64_t seed, std::uint64_t& count);
  bool matches(Material material) const {
    return material < is_match_.size() && is_match_[material];
  }
  HeightRanges within(const Column& column, const HeightRanges& domain);
  /// Returns the voxels for which the voxel `rise` above them, in the column at an offset, matches.
  HeightRanges matching(const Column& column, std::int32_t dx, std::int32_t rise,
                        std::int32_t dz) const;
  HeightRanges beside(const Column& column) const;
  HeightRanges in_noise(const Column& column, const HeightRanges& domain);

  FilterKind kind_ = FilterKind::solid;
  std::int32_t number_ = 0;
  std::vector<bool> is_match_;  // by material
  ClumpNoise clumps_{0, 1};
  std::uint64_t noise_voxels_ = 0;
  std::vector<BoundFilter> parts_;
};

}  // namespace runstone
