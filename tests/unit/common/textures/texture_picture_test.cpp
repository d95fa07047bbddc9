// Tests the decoding of pictures that may be damaged or hostile.
#include "common/textures/texture_picture.hpp"

#include <catch2/catch.hpp>

#include "common/core/texture.hpp"
#include "common/textures/png_pixels.hpp"
#include "tests/support/textures/test_png.hpp"

namespace runstone::test {

TEST_CASE("pictures of all kinds of colours are decoded", "[textures]") {
  const auto plain = read_texture(plain_png(32, 32, {10, 20, 30, 128}));
  REQUIRE(plain.has_value());
  CHECK(plain->edge == 32);
  REQUIRE(plain->rgba.size() == 32 * 32 * 4);
  CHECK(std::vector<std::uint8_t>(plain->rgba.end() - 4, plain->rgba.end()) ==
        std::vector<std::uint8_t>{10, 20, 30, 128});

  // A palette of two bits: the first row is 0, 1, 2, 3, ..., the others are 0.
  TestPng indexed{16, 16, 2, 3, {}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
  for (int row = 0; row < 16; ++row) {
    indexed.rows.push_back(0);
    for (int byte = 0; byte < 4; ++byte)
      indexed.rows.push_back(row == 0 ? std::uint8_t{0b00011011} : std::uint8_t{0});
  }
  const auto colours = read_texture(bytes_of(indexed));
  REQUIRE(colours.has_value());
  CHECK(std::vector<std::uint8_t>(colours->rgba.begin(), colours->rgba.begin() + 16) ==
        std::vector<std::uint8_t>{1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 255, 10, 11, 12, 255});

  TestPng grey{16, 16, 8, 0, {}};
  grey.rows.assign(16 * 17, 0);
  grey.rows[1] = 77;
  const auto grey_read = read_texture(bytes_of(grey));
  REQUIRE(grey_read.has_value());
  CHECK(grey_read->rgba[0] == 77);
  CHECK(grey_read->rgba[3] == 255);
}

TEST_CASE("a damaged picture fails, at every length", "[textures]") {
  const Bytes png = plain_png(16, 16, {1, 2, 3, 255});
  CHECK(read_texture(png).has_value());
  // The end of the file behind the pixels is not needed.
  for (std::size_t size = 0; size + 16 < png.size(); ++size)
    CHECK_FALSE(read_texture(ByteView(png).first(size)).has_value());
  for (std::size_t at = 0; at < png.size(); ++at) {
    Bytes flipped = png;
    flipped[at] ^= 0xff;
    const auto read = read_texture(flipped);
    if (read) CHECK(read->rgba.size() == std::size_t{4} * read->edge * read->edge);
  }
}

TEST_CASE("a small file that unpacks to much fails", "[textures]") {
  TestPng bomb{64, 64};
  bomb.rows.assign(std::size_t{8} << 20, 0);
  const Bytes file = bytes_of(bomb);
  CHECK(file.size() < kTextureBytesMax);
  CHECK(texture_edge(file).has_value());
  CHECK_FALSE(read_texture(file).has_value());
}

TEST_CASE("a second head does not change the sides of a picture", "[textures]") {
  const Bytes small = plain_png(16, 16, {}), large = plain_png(64, 64, {});
  Bytes file(small.begin(), small.begin() + 33);
  file.insert(file.end(), large.begin() + 8, large.end());
  CHECK_FALSE(read_texture(file).has_value());
}

TEST_CASE("a picture of any size is decoded up to a number of pixels", "[textures]") {
  const Bytes wide = plain_png(40, 3, {5, 6, 7, 8});
  CHECK(*png_sides(wide) == PngSides{40, 3});
  CHECK(read_png(wide, 120)->rgba.size() == 480);
  CHECK_FALSE(read_png(wide, 119).has_value());
  CHECK_FALSE(png_sides(ByteView(wide).first(23)).has_value());
  CHECK_FALSE(read_png(bytes_of({0xffffffff, 0xffffffff, 8, 6, {0}}), 1U << 24).has_value());
}

}  // namespace runstone::test
