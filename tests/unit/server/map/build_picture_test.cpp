// The picture of a build: what shows, where, and how large builds become small pictures.
#include "server/map/build_picture.hpp"

#include <png.h>

#include <catch2/catch.hpp>
#include <vector>

#include "common/runs/run_chunk.hpp"
#include "tests/support/formats/rsb_bytes.hpp"

namespace runstone::test {
namespace {

struct DecodedPicture {
  std::uint32_t side = 0;
  std::vector<std::uint8_t> rgba;
  /// Returns red, green, blue and alpha.
  std::vector<int> at(std::uint32_t x, std::uint32_t z) const {
    const std::uint8_t* pixel = &rgba[(x + std::size_t{side} * z) * 4];
    return {pixel[0], pixel[1], pixel[2], pixel[3]};
  }
};

DecodedPicture picture_of(const SampleBuild& build, std::int32_t side_max) {
  const Bytes file = rsb_of(build, 0);
  auto reader = RsbReader::open(rsb_source(file));
  REQUIRE(reader.has_value());
  const auto png = build_picture(*reader, side_max);
  if (!png) FAIL(png.error().message());
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_memory(&image, png->data(), png->size()) != 0);
  image.format = PNG_FORMAT_RGBA;
  DecodedPicture out;
  REQUIRE(image.width == image.height);
  out.side = image.width;
  out.rgba.resize(PNG_IMAGE_SIZE(image));
  REQUIRE(png_image_finish_read(&image, nullptr, out.rgba.data(), 0, nullptr) != 0);
  return out;
}

SampleBuild coloured_build(BuildSides sides) {
  SampleBuild build;
  build.info = sample_build_info(sides);
  for (const char* name : {"air", "blue", "red"}) {
    BuildMaterial material;
    material.row.name = name;
    build.materials.push_back(material);
  }
  build.materials[0].row.visibility = Visibility::empty;
  build.materials[0].row.colour = {0, 0, 0, 0};
  build.materials[1].row.colour = {0, 0, 200, 255};
  build.materials[2].row.colour = {200, 0, 0, 255};
  return build;
}

}  // namespace

TEST_CASE("a picture of a build shows the highest voxels, and nothing where nothing is",
          "[map][library]") {
  SampleBuild build = coloured_build({3, 2, 2});
  RunChunk cells = uniform_chunk({3, 2, 2}, 0);
  const auto put = [&](unsigned x, unsigned y, unsigned z, Material number) {
    fill(cells, x + 3 * (y + 2 * z), 1, number);
  };
  put(0, 0, 0, 2);  // blue
  put(1, 0, 0, 2);
  put(1, 1, 0, 3);  // red above blue
  put(2, 0, 0, 2);
  put(2, 1, 0, 1);  // air above blue
  put(0, 1, 1, 1);  // air alone
  build.sections.push_back({{}, cells});
  const DecodedPicture picture = picture_of(build, 8);
  REQUIRE(picture.side == 3);
  const auto is_blue = [&](std::uint32_t x, std::uint32_t z) {
    const auto p = picture.at(x, z);
    return p[2] > 100 && p[0] == 0 && p[3] == 255;
  };
  CHECK(is_blue(0, 0));
  CHECK(is_blue(2, 0));
  CHECK(picture.at(1, 0)[0] > 100);
  CHECK(picture.at(1, 0)[2] == 0);
  CHECK(picture.at(0, 1)[3] == 0);
  CHECK(picture.at(2, 2)[3] == 0);  // beyond the build
}

TEST_CASE("a picture of a build shows what is below a plant", "[map][library]") {
  SampleBuild build = coloured_build({1, 2, 1});
  build.materials[2].row.shape = {ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
  RunChunk cells = uniform_chunk({1, 2, 1}, 2);
  fill(cells, 1, 1, 3);  // red above blue
  build.sections.push_back({{}, cells});
  const DecodedPicture picture = picture_of(build, 8);
  REQUIRE(picture.side == 1);
  CHECK(picture.at(0, 0)[2] > 100);
}

TEST_CASE("a large build becomes a picture of the size that is allowed", "[map][library]") {
  SampleBuild build = coloured_build({200, 70, 1});
  const auto uniform = [&](std::uint32_t x, std::uint32_t y, Material number) {
    const SectionCoord at{x, y, 0};
    build.sections.push_back({at, uniform_chunk(section_extent(build.info.sides, at), number)});
  };
  uniform(0, 0, 2);
  uniform(3, 0, 2);
  uniform(0, 1, 3);  // above the first one
  const DecodedPicture picture = picture_of(build, 64);
  REQUIRE(picture.side == 50);  // four voxels along a pixel
  CHECK(picture.at(0, 0)[0] > 100);
  CHECK(picture.at(30, 0)[3] == 0);
  CHECK(picture.at(49, 0)[2] > 100);
  CHECK(picture.at(0, 1)[3] == 0);
}

TEST_CASE("a damaged build has no picture", "[map][library]") {
  SampleBuild build = coloured_build({3, 2, 2});
  build.sections.push_back({{}, uniform_chunk({3, 2, 2}, 2)});
  Bytes file = rsb_of(build, 0);
  file.pop_back();
  auto reader = RsbReader::open(rsb_source(file));
  REQUIRE(reader.has_value());
  CHECK_FALSE(build_picture(*reader, 8).has_value());
}

}  // namespace runstone::test
