// The rules for seams and pinholes.
#include "bench/frames/drawn_picture.hpp"

#include <catch2/catch.hpp>

using namespace runstone::bench;

namespace {

constexpr std::uint32_t kPlane = 7, kOther = 8;

/// Returns a plane of 5 x 5 pixels, its lowest corner at 2 2, with a strip of another beside it and
/// nothing around.
DrawnPicture two_planes() {
  DrawnPicture out{10, 9, std::vector<std::uint32_t>(90)};
  for (std::size_t y = 2; y < 7; ++y) {
    for (std::size_t x = 2; x < 8; ++x) out.pixels[y * 10 + x] = x < 7 ? kPlane : kOther;
  }
  return out;
}

PictureDifference after(std::size_t x, std::size_t y, std::uint32_t colour) {
  DrawnPicture picture = two_planes();
  picture.pixels[y * 10 + x] = colour;
  return difference_of(picture, two_planes());
}

}  // namespace

TEST_CASE("a pixel of another colour is a seam, and inside a plane a pinhole", "[frames]") {
  CHECK(covered_pixels(two_planes()) == 30);
  CHECK(difference_of(two_planes(), two_planes()).seam_pixels == 0);
  struct Case {
    std::size_t x, y;
    std::uint32_t colour;
    std::size_t pinholes;
  };
  const Case cases[] = {{4, 4, 0, 1},                          // the background shows through
                        {3, 3, kOther, 1},                     // another plane shows through
                        {5, 5, 0, 1},      {6, 4, kOther, 0},  // the line between two planes moved
                        {6, 4, 0, 0},      {2, 2, 0, 0},       // the outline moved
                        {1, 4, kPlane, 0},                     // the outline moved outwards
                        {0, 0, kPlane, 0}, {9, 8, kPlane, 0}};
  for (const Case& c : cases) {
    CAPTURE(c.x, c.y, c.colour);
    CHECK(after(c.x, c.y, c.colour).seam_pixels == 1);
    CHECK(after(c.x, c.y, c.colour).pinhole_pixels == c.pinholes);
  }
}

TEST_CASE("a pixel at the edge of the picture is not inside a plane", "[frames]") {
  const DrawnPicture full{3, 5, std::vector<std::uint32_t>(15, kPlane)};
  for (std::size_t pixel = 0; pixel < 15; ++pixel) {
    DrawnPicture picture = full;
    picture.pixels[pixel] = 0;
    CHECK(covered_pixels(picture) == 14);
    const PictureDifference difference = difference_of(picture, full);
    CHECK(difference.seam_pixels == 1);
    CAPTURE(pixel);
    CHECK(difference.pinhole_pixels == (pixel == 4 || pixel == 7 || pixel == 10 ? 1 : 0));
  }
}
