// PngFile: the pixels of a PNG file.
#pragma once
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <string>
#include <vector>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#if defined(__clang__)
#pragma GCC diagnostic ignored "-Wsign-conversion"
#endif
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace runstone::test {

class PngFile {
 public:
  explicit PngFile(const std::string& file) {
    int channels = 0;
    stbi_uc* const pixels = stbi_load(file.c_str(), &width, &height, &channels, 3);
    INFO(file);
    REQUIRE(pixels != nullptr);
    rgb.assign(pixels,
               pixels + static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
    stbi_image_free(pixels);
  }
  /// Returns the mean colour of a square of 2 r + 1 pixels around a place, whose coordinates are 0
  /// to 1 from the left and the top.
  std::array<int, 3> mean(double u, double v, int r = 2) const {
    const int x0 = static_cast<int>(u * width), y0 = static_cast<int>(v * height);
    std::array<int, 3> sum{};
    for (int y = y0 - r; y <= y0 + r; ++y) {
      for (int x = x0 - r; x <= x0 + r; ++x) {
        const std::size_t at = (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                static_cast<std::size_t>(x)) *
                               3;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += rgb.at(at + c);
      }
    }
    for (int& c : sum) c /= (2 * r + 1) * (2 * r + 1);
    return sum;
  }

  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
};

inline bool is_red(const std::array<int, 3>& p) { return p[0] > 1.5 * p[1] && p[0] > 1.5 * p[2]; }
inline bool is_green(const std::array<int, 3>& p) {
  return p[1] > 1.15 * p[0] && p[1] > 1.15 * p[2];
}
inline bool is_sky(const std::array<int, 3>& p) { return p[2] >= p[0] && p[2] > 120; }

}  // namespace runstone::test
