// Height maps: PNG in and out. A pixel is a column of voxels: x to the east, the rows to the south. Its
// sample is the height of the column, from y = 0 on. A second PNG of equal size may give the colours.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

inline constexpr std::uint32_t kHeightMapSideMax = 8192;
inline constexpr std::uint32_t kHeightMapHeightMax = 65'535;

struct HeightMapOptions {
  // Voxels of a column with the greatest sample (255, or 65,535 of 16 bits), 1 .. kHeightMapHeightMax. 0:
  // what write_height_map() wrote in the file, otherwise 255.
  std::uint32_t height_max = 0;
  std::size_t colours_max = 255;  // 1 .. 255
  std::string ground = "stone";   // name of the block without a colour map
};

/// Reads a grey PNG of up to 16 bits and, if `colours` is not empty, a PNG of any kind with the colours
/// of the columns. Alpha is ignored. A column has round(sample * height_max / greatest sample) voxels of
/// one block: the ground, or "colour #rrggbb". More colours than `colours_max` become that many. Fails
/// with limit_exceeded if a side is above kHeightMapSideMax, and with bad_value if a PNG is interlaced or
/// damaged, if the heights are not grey, if the sizes differ, or if an option is outside its range. The
/// offset of an error is a byte of the PNG with the fault. Cost: O(pixels + runs). Memory: 64 rows and
/// 2 MiB.
Result<ForeignInfo> read_height_map(ByteView heights, ByteView colours,
                                    const HeightMapOptions& options, const PieceSink& sink);
/// Reads a height map alone with the default options: the reader of Format.
Result<ForeignInfo> read_height_map(ByteView heights, const PieceSink& sink);

/// Writes the build from above: as the sample of a pixel, the height of the highest cell of its column
/// that is not empty, plus 1; 0 if there is none. A build of up to 255 layers has 8 bits, otherwise 16,
/// and the text "runstone:height_max". What lies below the highest cell is lost. Fails with
/// limit_exceeded if the build is longer than kHeightMapSideMax or higher than kHeightMapHeightMax. Cost:
/// O(runs + columns).
Result<void> write_height_map(const FileBuild& build, const FormatSink& sink);
/// Writes the colours of these cells as RGB of 8 bits; black if there is none. Fails as
/// write_height_map().
Result<void> write_colour_map(const FileBuild& build, const FormatSink& sink);

}  // namespace runstone
