// The drawing of a mesh shows nothing that lies behind.
#include "tests/wireframe/wireframe.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

using namespace runstone;

namespace {

/// Returns the faces +x, +y and +z of the cube of `side` voxels at `at`, `at`, `at`.
std::vector<Quad> cube(unsigned at, unsigned side, Material material) {
  const auto low = static_cast<std::uint8_t>(at);
  const auto last = static_cast<std::uint8_t>(at + side - 1);
  const auto size = static_cast<std::uint8_t>(side);
  return {pack({last, low, low, size, size, Direction::pos_x, material}),
          pack({low, last, low, size, size, Direction::pos_y, material}),
          pack({low, low, last, size, size, Direction::pos_z, material})};
}

Image drawn(const std::vector<Quad>& quads) {
  Image image = wireframe::blank(130, 120);
  wireframe::draw(quads, {10, 5, 110, 110}, 1, image);
  return image;
}

std::ptrdiff_t dark_pixels(const Image& image) {
  std::ptrdiff_t out = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) out += image.rgb[i] < 60 ? 1 : 0;
  return out;
}

}  // namespace

TEST_CASE("a wireframe shows outlines and leaves hidden lines out", "[wireframe]") {
  const std::vector<Quad> outer = cube(0, 8, 1);
  const Image alone = drawn(outer);
  // Nine edges of about 55 pixels each.
  CHECK(dark_pixels(alone) > 360);
  CHECK(dark_pixels(alone) < 750);
  CHECK(alone.rgb[0] == 255);

  std::vector<Quad> with_inner = cube(2, 3, 2);
  with_inner.insert(with_inner.end(), outer.begin(), outer.end());
  CHECK(drawn(with_inner).rgb == alone.rgb);
  std::reverse(with_inner.begin(), with_inner.end());
  CHECK(drawn(with_inner).rgb == alone.rgb);

  std::vector<Quad> halves = outer;  // the top in two
  halves[1] = pack({0, 7, 0, 8, 4, Direction::pos_y, 1});
  halves.push_back(pack({4, 7, 0, 8, 4, Direction::pos_y, 1}));
  CHECK(dark_pixels(drawn(halves)) > dark_pixels(alone) + 30);
}
