// Image: the pixels of a frame in memory, which can be written to a PNG file.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace runstone {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top, 3 bytes a pixel, sRGB
};

/// Returns the image at half the width and height, with the mean of each 2 x 2 pixels. It makes a
/// smooth picture of a frame that was drawn twice as large. An odd last row or column is dropped.
Image halved(const Image& image);

/// Writes a PNG file. Returns false if it cannot be written.
bool write_png(const std::string& file, const Image& image);

}  // namespace runstone
