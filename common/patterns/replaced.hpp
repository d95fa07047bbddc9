// Replacing: the voxels of a box that a pattern changes, as a build, made in steps of bounded work.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/builds/build_builder.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/patterns/bound_filter.hpp"
#include "common/patterns/bound_mix.hpp"
#include "common/runs/run_builder.hpp"
#include "common/sculpt/column_changes.hpp"
#include "common/sculpt/ground_columns.hpp"
#include "common/sculpt/voxel_rows.hpp"

namespace runstone {

/// Makes the build of exactly the voxels of a box that pass a filter and whose material becomes
/// another one; its other cells are untouched. Reads columns in slices. A filter sees the voxels one
/// beyond the box as well; where they are not known, they match nothing. One thread.
class Replacing {
 public:
  /// Without a filter all voxels pass. If `only` is not null, only its voxels are replaced. Fails
  /// with limit_exceeded if a side of the box is longer than kBuildSideMax. Requires a box that is
  /// not empty and lies in the world, and a valid chunk edge.
  static Result<Replacing> of(const VoxelBox& box, BoundMix mix, std::optional<BoundFilter> filter,
                              std::int32_t chunk_edge, ChunkLookup chunks,
                              VoxelRowsPtr only = nullptr);

  /// Goes on until all voxels are done or `work` is used up, and takes what it used from `work`. The
  /// units are
  ///   - the square of the chunk edge for each chunk whose columns are read;
  ///   - 1 for each column, for each run, for each condition of the filter in each run, for each
  ///     voxel that is decided by itself, and for each one that is searched in `only`.
  /// Columns are read in slices of up to 128 x 128 columns; a slice may exceed `work` once. Returns
  /// true when all voxels are done. Fails with
  ///   - not_found if a chunk of the box is not known;
  ///   - limit_exceeded if the build takes more than kBuildBytesMax or has too many materials.
  /// Do not call it after a failure.
  Result<bool> step(std::uint64_t& work);
  /// Returns the number of voxels that were decided one by one: those that get a mix of several
  /// materials, and those that `noise` takes.
  std::uint64_t decided() const;
  /// Returns the build, or a null build if no voxel changes. Fails as step() does. Requires that
  /// step() has returned true.
  Result<PlacedBuild> finish();

 private:
  /// A section of the present stack, and its heights in the world.
  struct Section {
    std::optional<RunBuilder> cells;  // nullopt: nothing in it changes yet
    std::int32_t low = 0, high = 0;
  };

  Replacing(const VoxelBox& box, BoundMix mix, std::optional<BoundFilter> filter,
            std::int32_t chunk_edge, ChunkLookup chunks, VoxelRowsPtr only, BuildBuilder builder);
  Result<void> read_slice(std::uint64_t& work);
  void begin_stack();
  Result<void> put_stack();
  /// Moves to the next stack, in the next slice if this one is done.
  void next_stack();
  Result<void> put_column(std::uint64_t& work);
  /// Returns the voxels of the present column that are in only_.
  HeightRanges chosen(const HeightRanges& ranges, std::uint64_t& work) const;
  void mix_run(HeightRange range, Material old);
  void set(std::int32_t low, std::int32_t high, Material material);
  Extent extent_of(const Section& section) const;

  VoxelBox box_;
  BoundMix mix_;
  std::optional<BoundFilter> filter_;
  std::int32_t chunk_edge_;
  ChunkLookup chunks_;
  VoxelRowsPtr only_;  // null: all voxels
  BuildBuilder builder_;
  // The slice: sections [slice_low_, slice_high_) along x and z.
  SectionPos slice_low_, slice_high_;
  std::optional<GroundColumns> columns_;  // of the slice; nullopt: not read yet
  // The stack of sections at stack_, whose columns lie in [stack_min_, stack_max_) along x and z.
  SectionPos stack_;
  VoxelPos stack_min_, stack_max_;
  std::vector<Section> sections_;  // from below to above
  std::int32_t x_ = 0, z_ = 0;     // the next column
  std::uint32_t line_ = 0;         // its number in the stack
  std::size_t section_ = 0;        // that holds the voxel that was set last in the column
  std::uint64_t mixed_ = 0;
  std::uint64_t run_units_ = 1;  // of work, for each run of a column
  bool has_changes_ = false;
  bool is_full_ = false;  // the palette has no room
  bool is_done_ = false;
};

/// Does the work of Replacing at once. A null filter lets all voxels pass. Fails as its functions do.
/// Requires what they require. Cost: O(runs + columns * chunks above each other + voxels that are
/// decided one by one).
Result<PlacedBuild> replaced(const VoxelBox& box, const BoundMix& mix, const BoundFilter* filter,
                             std::int32_t chunk_edge, const ChunkLookup& chunks);

}  // namespace runstone
