// A picture of a build from above, as the map draws the world: PNG of a square. Pure.
#pragma once
#include <cstdint>
#include <string>

#include "common/formats/rsb_reader.hpp"

namespace runstone {

/// The longest side of a picture of a build, in pixels.
inline constexpr std::int32_t kBuildPictureSideMax = 256;

/// Reads the sections of a build that are left, and returns a PNG file: +x right and +z down, a
/// voxel for each pixel if the build is at most `side_max` wide, otherwise a square of voxels, of
/// which the highest one shows. Where nothing shows, and around a build that is no square, the picture is
/// transparent. Fails as RsbReader::next() does. Requires 1 <= side_max <= kBuildPictureSideMax.
/// Memory: that of the reader, and some 16 bytes a pixel. Cost: O(runs + columns of the sections).
RsbResult<std::string> build_picture(RsbReader& reader,
                                     std::int32_t side_max = kBuildPictureSideMax);

}  // namespace runstone
