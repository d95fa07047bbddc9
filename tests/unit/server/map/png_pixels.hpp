// Reads a PNG file with libpng, as browsers do.
#pragma once
#include <png.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace runstone::test {

inline std::vector<std::uint32_t> pixels_of(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_memory(&image, png.data(), png.size()) != 0);
  image.format = PNG_FORMAT_RGBA;
  std::vector<std::uint32_t> out(std::size_t{image.width} * image.height);
  REQUIRE(png_image_finish_read(&image, nullptr, out.data(), 0, nullptr) != 0);
  return out;
}

}  // namespace runstone::test
