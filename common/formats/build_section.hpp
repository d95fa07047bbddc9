// BuildSection: a part of a build as runs, and its bytes in an .rsb. A section is a cuboid of cells
// with sides up to kBuildSectionEdge. A cell number is 0 for an untouched cell, which keeps the
// present voxel, and otherwise the index of a material of the build + 1. Sections of which no cell
// is touched do not exist.
#pragma once
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/formats/build_head.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The place of a section in the grid of sections of its build.
struct SectionCoord {
  std::uint32_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const SectionCoord&, const SectionCoord&) = default;
};

struct BuildSection {
  SectionCoord at;
  RunChunk cells;  // cell numbers in place of materials; any axis order
  friend bool operator==(const BuildSection&, const BuildSection&) = default;
};

/// Returns the number of sections along each axis.
BuildSides section_counts(const BuildSides& sides);
/// Returns the number of a section: x + count_x * (y + count_y * z). Sections ascend by it.
/// Requires a place in the grid.
std::uint64_t section_number(const BuildSides& sides, SectionCoord at);
/// Returns the place of a section. Requires number < count_x * count_y * count_z.
SectionCoord section_at(const BuildSides& sides, std::uint64_t number);
/// Returns the extent of a section, whose sides are 1 .. kBuildSectionEdge.
Extent section_extent(const BuildSides& sides, SectionCoord at);
/// Returns the lowest corner of a section in the build.
VoxelPos section_corner(SectionCoord at);

/// Returns the number of touched cells. Cost: O(runs).
std::uint64_t touched_cells(const RunChunk& cells);

/// Fails with bad_value, not_canonical or broken_invariant if the cells are not those of a section
/// with this extent, have a number above `material_count`, or are all untouched. Cost: O(runs).
Result<void> validate_section(const RunChunk& cells, Extent extent, std::uint32_t material_count);

/// Appends the bytes of a valid section, without its number (docs/builds.md).
void encode_section(const RunChunk& cells, Bytes& out);
/// Reads a section behind its number. Returns its cells, which are valid; after a rejection the
/// result is not meaningful. The memory that it allocates is proportional to the bytes present and
/// at most 6 bytes a cell.
RunChunk decode_section(ByteReader& r, Extent extent, std::uint32_t material_count);

}  // namespace runstone
