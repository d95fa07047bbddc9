// Build: a box of cells of any size, kept as runs. Each cell is a material (empty included) or
// untouched, which keeps the present voxel where the build is pasted. The box is cut into sections by
// planes across each axis. A section is a cuboid of runs, as the cells of a Clipboard: a cell number
// is 0 (untouched) or palette index + 1. Invariants (BuildBuilder checks them):
//   - along each axis the cuts ascend from 0 to the side, which is at most kBuildSideMax, and
//     neighbours are 1 .. kSideMax apart;
//   - the runs of each section are canonical, and its sides are the distances of the cuts;
//   - the materials of the palette differ, and each is the material of at least one cell;
//   - memory_bytes() is at most the bound that the maker gave, kBuildBytesMax by default.
//
// Sections with equal content may be one object: all uniform ones of equal sides are, and the copies
// of a stack are. A section is never expanded to a grid. Positions are those of cells, from 0.
// Thread: immutable, so any thread may read it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The memory that a build takes at most.
inline constexpr std::size_t kBuildBytesMax = std::size_t{256} * 1024 * 1024;
/// The materials of a build. Cell numbers have 16 bits, and 0 is untouched.
inline constexpr std::size_t kBuildPaletteMax = 65'535;

/// The planes that cut a build into sections, by axis: 0, ..., side.
using BuildCuts = std::array<std::vector<std::int32_t>, 3>;

/// Returns the cuts of a side by a grid of `edge` cells, whose planes lie at the multiples of `edge`
/// minus `offset`. Requires a positive side, 1 <= edge <= kSideMax and 0 <= offset < edge.
std::vector<std::int32_t> grid_cuts(std::int32_t side, std::int32_t edge, std::int32_t offset = 0);

using SectionPtr = std::shared_ptr<const RunChunk>;

/// Place of a section in the grid of a build.
struct SectionPos {
  std::uint32_t x = 0, y = 0, z = 0;
  friend bool operator==(const SectionPos&, const SectionPos&) = default;
};

class Build {
 public:
  /// Returns the sides in cells, each at least 1.
  VoxelPos sides() const { return {cuts_[0].back(), cuts_[1].back(), cuts_[2].back()}; }
  VoxelBox box() const { return {{0, 0, 0}, sides()}; }
  std::uint64_t volume() const;
  const BuildCuts& cuts() const { return cuts_; }
  const std::vector<Material>& palette() const { return palette_; }
  /// Returns the material of a cell number. Requires 0 < number <= palette size.
  Material material(std::uint16_t number) const { return palette_[number - 1U]; }
  /// Returns the cell number of a material, or nullopt if no cell has it. Cost: O(palette).
  std::optional<std::uint16_t> number_of(Material material) const;

  /// Returns the number of sections along each axis.
  SectionPos section_counts() const;
  /// Returns a section. Requires a place below section_counts().
  const SectionPtr& section(SectionPos at) const { return sections_[grid_[grid_index(at)]]; }
  /// Returns the cells that a section covers.
  VoxelBox box_of(SectionPos at) const;
  /// Returns the section that holds a cell. Requires a cell of the build. Cost: O(log sections).
  SectionPos section_of(VoxelPos cell) const;
  /// Returns the sections, each once, and by place of the grid (x fastest, z slowest) the index of
  /// the section there.
  std::span<const SectionPtr> distinct_sections() const { return sections_; }
  std::span<const std::uint32_t> grid() const { return grid_; }

  /// Returns the number of touched cells, at least 1.
  std::uint64_t touched() const { return touched_; }
  /// Returns the number of cells that are touched and not empty.
  std::uint64_t solid() const { return solid_; }
  /// Returns the number of runs, those of each section counted once.
  std::uint64_t run_count() const;
  /// Returns the bytes of memory that the build takes. Sections count in full, although builds that
  /// were made from each other may share some.
  std::size_t memory_bytes() const { return memory_bytes_; }
  /// Returns the material of a cell, or nullopt if it is untouched. Requires a cell of the build.
  /// Cost: O(log sections + log runs).
  std::optional<Material> at(VoxelPos cell) const;

 private:
  friend class BuildBuilder;
  Build() = default;
  std::size_t grid_index(SectionPos at) const {
    return at.x + (cuts_[0].size() - 1) * (at.y + (cuts_[1].size() - 1) * std::size_t{at.z});
  }

  BuildCuts cuts_;
  std::vector<Material> palette_;
  std::vector<SectionPtr> sections_;
  std::vector<std::uint32_t> grid_;
  std::uint64_t touched_ = 0, solid_ = 0;
  std::size_t memory_bytes_ = 0;
};

using BuildPtr = std::shared_ptr<const Build>;

/// Returns the cells of a box as runs of cell numbers, joined from the sections that it meets, in the
/// axis order of the section with the most runs. Requires a box inside the build that is not empty
/// and has sides up to kSideMax. Cost: O(runs of the sections that it meets + lines of the box *
/// sections along them); O(sections) if all cells are equal.
RunChunk cells_in(const Build& build, const VoxelBox& box);

/// Returns the cells of a box that may lie partly outside the build: cells outside are untouched.
/// Requires a box that is not empty and has sides up to kSideMax. Cost: that of cells_in() for the
/// part inside, and O(runs + lines of it).
RunChunk cells_around(const Build& build, const VoxelBox& box);

/// Returns what a box shows in a picture: the materials of its cells. Untouched cells and those
/// outside the build are empty. Requires a box that is not empty and has sides up to kSideMax. Cost:
/// that of cells_in() for the part inside, and O(runs + lines of it).
RunChunk materials_in(const Build& build, const VoxelBox& box);

}  // namespace runstone
