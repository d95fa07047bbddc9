// Image: a picture in memory, and its way to a file.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace runstone {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top, 3 bytes a pixel, sRGB
};

/// Half the size each way, averaging 2 x 2 pixels: a frame drawn twice as large becomes a smooth picture.
/// An odd last row or column is dropped.
Image halved(const Image& image);

/// Writes a PNG; false if the file cannot be written.
bool write_png(const std::string& file, const Image& image);

}  // namespace runstone
