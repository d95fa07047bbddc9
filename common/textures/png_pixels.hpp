// PngPixels: the pixels of a PNG of any size that its reader allows.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/png_head.hpp"
#include "common/core/result.hpp"

namespace runstone {

struct PngPixels {
  PngSides sides;
  std::vector<std::uint8_t> rgba;  // width * height pixels of four bytes, sRGB, the upper row first
};

/// Decodes a PNG. Fails before anything is decoded if it is no PNG, or has more than `pixels_max`
/// pixels, which are at most 2^24, and if it is damaged. Memory: some 16 bytes for each of
/// `pixels_max`, or 256 KiB if that is more, whatever the bytes are. Thread: any.
Result<PngPixels> read_png(ByteView png, std::uint32_t pixels_max);

}  // namespace runstone
