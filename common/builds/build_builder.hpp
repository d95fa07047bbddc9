// BuildBuilder: makes a build section by section. Sections that are not put are untouched.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Returns the cuts of a build with the place and the sides of a box in the world: they lie on the
/// borders of a grid of cubes, such as chunks, that begins at the origin of the world. Requires a box
/// that is not empty, and 1 <= edge <= kSideMax. Cost: O(cubes along the sides).
BuildCuts world_cuts(const VoxelBox& box, std::int32_t edge);

class BuildBuilder {
 public:
  /// Requires cuts as Build has them. Fails with limit_exceeded if a side is longer than
  /// kBuildSideMax, or if the grid alone takes more than `bytes_max`. Cost: O(sections).
  static Result<BuildBuilder> of(BuildCuts cuts, std::size_t bytes_max = kBuildBytesMax);

  const BuildCuts& cuts() const { return made_.cuts_; }
  /// Returns the cell number of a material, which it adds to the palette if it is new; nullopt if
  /// the palette is full. Cost: O(1).
  std::optional<std::uint16_t> number_of(Material material);

  /// Sets a section, which was not put before. Its runs hold cell numbers of number_of(). Fails with
  /// limit_exceeded if the build takes more memory than allowed. Requires canonical runs with the
  /// sides of the section. Cost: O(runs).
  Result<void> put(SectionPos at, RunChunk cells);
  /// Sets a section to an object that other places may have, too. Cost: O(log distinct sections) and,
  /// if it is new here, O(runs).
  Result<void> put(SectionPos at, SectionPtr cells);

  /// Returns the build, and leaves the builder empty. Numbers without a cell leave the palette. Fails
  /// with bad_value if no cell is touched. Cost: O(sections + runs, if a number has no cell).
  Result<BuildPtr> finish();

 private:
  explicit BuildBuilder(std::size_t bytes_max) : bytes_max_(bytes_max) {}
  Result<std::uint32_t> add(SectionPtr cells);
  SectionPtr uniform(Extent extent, std::uint16_t number);

  std::size_t bytes_max_;
  Build made_;
  std::vector<std::uint16_t> numbers_;              // by material; 0: not in the palette
  std::map<const RunChunk*, std::uint32_t> index_;  // of the sections that were added
  std::map<std::tuple<Extent, std::uint16_t>, SectionPtr> uniform_;
  struct CellCount {
    std::uint64_t touched = 0, solid = 0;
  };
  std::vector<CellCount> cells_;  // by distinct section
  std::vector<bool> is_used_;     // by cell number
};

}  // namespace runstone
