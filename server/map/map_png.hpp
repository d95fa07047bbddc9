// PNG files (ISO/IEC 15948) of map tiles. Pure.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace runstone {

/// Returns a PNG file of a square picture: pixels in rows from the top, red in the lowest byte,
/// alpha in the highest. A picture of at most 256 colours has a palette, which makes it smaller and
/// faster to write. Requires side * side pixels, side > 0. Cost: O(pixels).
std::string png_of(std::span<const std::uint32_t> pixels, std::int32_t side);

}  // namespace runstone
