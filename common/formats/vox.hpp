// MagicaVoxel .vox: in and out. A file has models of up to 256^3 voxels, a palette of 255 colours with
// materials, and since version 0.99 a scene graph that places models, turned, mirrored and several
// times. Format: MagicaVoxel-file-format-vox.txt and -vox-extension.txt of its author.
//
// Axes: the z axis of a file is up, and its system is right-handed. A voxel at (x, y, z) of the scene
// is at (x, z, -1 - y) here, so east stays east and nothing is mirrored.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

inline constexpr std::int32_t kVoxModelSideMax = 256;
inline constexpr std::size_t kVoxColours = 256;  // colour 0 is no voxel
/// The nodes and models of a file, and the models that its scene places.
inline constexpr std::size_t kVoxNodesMax = std::size_t{1} << 16;
/// The voxels of all placed models, each placing counted.
inline constexpr std::uint64_t kVoxPlacedMax = std::uint64_t{1} << 31;
/// The voxels that a file holds here, so that its sizes fit 31 bits.
inline constexpr std::uint64_t kVoxWrittenMax = 500'000'000;

/// Reads a .vox. The pieces are the models as the scene places them, in the order of the scene; where
/// models overlap, the later one counts. Hidden nodes and layers are left out. Of an animation the
/// first frame is read. A file without a scene graph has its models in a row along x, with a gap of 1.
/// A block has the colour of its voxel. Its name is one that write_vox() gave, otherwise the note of
/// its row of the palette, or "colour", then "#rrggbb" (with "aa" if it is transparent), and
/// "rough N", "light N" if it has such a material, in percent. So equal looks have equal names in all
/// files. Models of Teardown (TDCZ) are read, too. The offset of an error is a byte of the file. Cost:
/// O(bytes + runs of the placed models). Memory: the runs of each model that is placed, one piece of
/// 128^3 voxels as a list, and 16 MiB.
Result<ForeignInfo> read_vox(ByteView file, const PieceSink& sink);

/// Writes a build as a .vox of version 150, with one model for each box of 256^3 voxels that is not
/// empty, and a scene graph that puts them together around the middle of the scene. Names, states, looks
/// and the place of the build stand in entries `_runstone_...` of dictionaries, which other programs
/// ignore. Empty cells and untouched ones are both no voxel. Fails with limit_exceeded if there are more
/// than 255 materials that are not empty, or more than kVoxWrittenMax voxels, and with bad_value if
/// there are none. Cost: O(voxels).
Result<void> write_vox(const FileBuild& build, const FormatSink& sink);

}  // namespace runstone
