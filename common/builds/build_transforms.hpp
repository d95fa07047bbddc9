// Transforms of builds: each makes a new build section by section, in runs, and leaves the old one as
// it is.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "common/builds/build.hpp"
#include "common/core/result.hpp"
#include "common/edits/clipboard/orientation.hpp"

namespace runstone {

/// Returns the build as it lies in the world with this orientation: rotated by quarter turns and
/// mirrored. A turn without a mirror renames the axes of each section and copies its runs. Fails with
/// limit_exceeded if the result takes more than `bytes_max`; it takes about as much as the build.
/// Cost: O(sections + runs + lines of the sections that are mirrored).
Result<BuildPtr> turned(const Build& build, const Orientation& orientation,
                        std::size_t bytes_max = kBuildBytesMax);

/// Returns the build and `times` copies of it. Copy i is moved by i * `offset`; where copies overlap,
/// the touched cells of the later one count. Cells between the copies are untouched. The corner of
/// the result is that of the first or of the last copy, whichever is smaller along each axis
/// (stack_corner()). If the copies lie beside each other along one axis, they share their sections,
/// and the result takes little more memory than the build. Fails with limit_exceeded if the result
/// takes more than `bytes_max` or is longer than kBuildSideMax, and with bad_value if the offset is 0.
/// Requires 1 <= times. Cost: O(sections of the result) if the copies share their sections, otherwise
/// that of cells_in() for each copy and section of 64 cells.
Result<BuildPtr> stacked(const Build& build, VoxelPos offset, std::int32_t times,
                         std::size_t bytes_max = kBuildBytesMax);

/// Returns the corner of stacked() relative to the corner of the build: each coordinate is 0 or
/// negative. Requires that stacked() succeeds with these values.
VoxelPos stack_corner(VoxelPos offset, std::int32_t times);

enum class PaletteOrder : std::uint8_t {
  kept,       // of the palette before; of equal entries the place of the first
  ascending,  // by id, so that equal cells make equal palettes
};

/// Returns the build with other materials, by palette entry. Cells of an entry without a new material
/// become untouched. Entries may become equal. Fails with bad_value if no cell is left touched, and
/// with limit_exceeded if the result takes more than `bytes_max`. Requires one entry for each of
/// the palette. Cost: O(sections + runs).
Result<BuildPtr> with_materials(const Build& build,
                                std::span<const std::optional<Material>> palette,
                                std::size_t bytes_max = kBuildBytesMax,
                                PaletteOrder order = PaletteOrder::kept);

/// Returns cells of a build in which later touched cells replace those before. Requires the same
/// extent. The result is in the axis order of `below`. Cost: O(runs), and that of reorder() if the
/// orders differ.
RunChunk overlaid(const RunChunk& below, const RunChunk& above);

}  // namespace runstone
