// Image: the pixels of a frame in memory.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/bytes.hpp"

namespace runstone {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top, 3 bytes a pixel, sRGB
};

/// Returns the image at half the width and height, with the mean of each 2 x 2 pixels. It makes a
/// smooth picture of a frame that was drawn twice as large. An odd last row or column is dropped.
Image halved(const Image& image);

/// Returns the bytes of a PNG file, or no bytes if there is no memory for them. Cost: O(pixels).
Bytes encode_png(const Image& image);

}  // namespace runstone
