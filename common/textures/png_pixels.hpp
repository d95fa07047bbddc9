// PngPixels: the pixels of a PNG of any size that its reader allows.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

struct PngSides {
  std::uint32_t width = 0, height = 0;
  friend bool operator==(const PngSides&, const PngSides&) = default;
};

struct PngPixels {
  PngSides sides;
  std::vector<std::uint8_t> rgba;  // width * height pixels of four bytes, sRGB, the upper row first
};

/// Returns the sides that the head of a PNG names, or nullopt if the bytes are no PNG or a side is
/// 0.
std::optional<PngSides> png_sides(ByteView png);

/// Decodes a PNG. Fails before anything is decoded if it is no PNG, or has more than `pixels_max`
/// pixels, which are at most 2^24, and if it is damaged. Memory: some 16 bytes for each of
/// `pixels_max`, or 256 KiB if that is more, whatever the bytes are. Thread: any.
Result<PngPixels> read_png(ByteView png, std::uint32_t pixels_max);

}  // namespace runstone
