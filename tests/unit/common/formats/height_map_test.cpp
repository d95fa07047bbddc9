#include "common/formats/height_map.hpp"

#include <png.h>

#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <string>

#include "common/formats/look_material.hpp"
#include "common/materials/colour_quantiser.hpp"
#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

const Format kHeightMap{"height map", ".png", read_height_map, material_of_look, write_height_map};

/// Writes a PNG with libpng. `bytes` are rows without filters, upper bytes first.
Bytes png_of_rows(std::uint32_t width, std::uint32_t height, int bits, int kind, const Bytes& bytes,
                  int interlace = PNG_INTERLACE_NONE) {
  Bytes out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep data, png_size_t size) {
        auto* to = static_cast<Bytes*>(png_get_io_ptr(p));
        to->insert(to->end(), data, data + size);
      },
      nullptr);
  png_set_IHDR(png, info, width, height, bits, kind, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  std::vector<png_bytep> rows;
  for (std::uint32_t y = 0; y < height; ++y)
    rows.push_back(const_cast<png_bytep>(bytes.data() + y * row_bytes));
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

/// The names of the voxels of each column, from below, without those above the column.
using Columns = std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::string>>;

Columns columns_of(const Bytes& heights, const Bytes& colours, const HeightMapOptions& options) {
  std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, std::string> voxels;
  const auto read =
      read_height_map(heights, colours, options, [&](ForeignPiece&& piece) -> Result<void> {
        REQUIRE(validate_runs(piece.voxels).has_value());
        for (std::uint32_t i = 0; i < piece.voxels.volume(); ++i) {
          const LocalPos at = pos_of(i, piece.voxels.extent, piece.voxels.order);
          const Material material = material_at(piece.voxels, at);
          if (material != 0)
            voxels[{piece.origin.x + at.x, piece.origin.z + at.z, piece.origin.y + at.y}] =
                piece.blocks.at(material - 1U).name;
        }
        return {};
      });
  INFO((read ? "" : read.error().what));
  REQUIRE(read.has_value());
  Columns out;
  for (const auto& [at, name] : voxels) {
    auto& column = out[{std::get<0>(at), std::get<1>(at)}];
    // Columns have no holes.
    REQUIRE(std::get<2>(at) == static_cast<std::int32_t>(column.size()));
    column.push_back(name);
  }
  return out;
}

Error map_error(const Bytes& heights, const Bytes& colours = {}, HeightMapOptions options = {}) {
  const auto read =
      read_height_map(heights, colours, options, [](ForeignPiece&&) { return Result<void>{}; });
  REQUIRE_FALSE(read.has_value());
  return read.error();
}

}  // namespace

TEST_CASE("a pixel of a height map is a column of voxels", "[formats]") {
  Columns expected;
  expected[{1, 0}] = std::vector<std::string>(3, "stone");
  expected[{0, 1}] = std::vector<std::string>(200, "stone");
  CHECK(columns_of(png_of_rows(2, 2, 8, PNG_COLOR_TYPE_GRAY, {0, 3, 200, 0}), {}, {}) == expected);
  CHECK(columns_of(png_of_rows(2, 2, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {0, 1, 3, 0, 200, 9, 0, 255}),
                   {}, {}) == expected);
  CHECK(columns_of(png_of_rows(2, 2, 16, PNG_COLOR_TYPE_GRAY, {0, 0, 0, 3, 0, 200, 0, 0}), {},
                   {65'535, 255, "stone"}) == expected);
  // Four bits: 15 is the greatest sample.
  expected.clear();
  expected[{0, 0}] = std::vector<std::string>(30, "dirt");
  expected[{1, 0}] = std::vector<std::string>(2, "dirt");
  CHECK(columns_of(png_of_rows(2, 1, 4, PNG_COLOR_TYPE_GRAY, {0xf1}), {}, {30, 255, "dirt"}) ==
        expected);
}

TEST_CASE("a colour map colours the columns of a height map", "[formats]") {
  const Bytes heights = png_of_rows(2, 1, 8, PNG_COLOR_TYPE_GRAY, {2, 1});
  const Columns expected = {{{0, 0}, {"colour #010203", "colour #010203"}},
                            {{1, 0}, {"colour #fffefd"}}};
  const Bytes rgb = {1, 2, 3, 255, 254, 253};
  CHECK(columns_of(heights, png_of_rows(2, 1, 8, PNG_COLOR_TYPE_RGB, rgb), {}) == expected);
  CHECK(columns_of(heights,
                   png_of_rows(2, 1, 8, PNG_COLOR_TYPE_RGBA, {1, 2, 3, 0, 255, 254, 253, 9}),
                   {}) == expected);
  const Columns grey = columns_of(heights, png_of_rows(2, 1, 8, PNG_COLOR_TYPE_GRAY, {7, 8}), {});
  CHECK(grey.at({1, 0}).front() == "colour #080808");
}

TEST_CASE("a colour map with more colours than allowed gets similar ones", "[formats]") {
  SplitMix64 rng{5};
  Bytes rgb, heights(64 * 70, 1);
  for (std::size_t i = 0; i < heights.size() * 3; ++i)
    rgb.push_back(static_cast<std::uint8_t>(rng.below(256)));
  const Bytes file = png_of_rows(64, 70, 8, PNG_COLOR_TYPE_RGB, rgb);
  for (const std::size_t most : {255U, 16U, 1U}) {
    std::set<std::string> names;
    for (const auto& [at, column] :
         columns_of(png_of_rows(64, 70, 8, PNG_COLOR_TYPE_GRAY, heights), file, {255, most, ""}))
      names.insert(column.front());
    CHECK(names.size() == most);
  }
  ColourQuantiser few;
  for (int i = 0; i < 1000; ++i) few.add({static_cast<std::uint8_t>(i % 250), 1, 2});
  few.choose(255);
  CHECK(few.colours().size() == 250);
  CHECK(few.colours()[few.index_of({77, 1, 2})] == ColourQuantiser::Rgb{77, 1, 2});
  few.choose(100);
  CHECK(few.colours().size() <= 100);
  const auto near = few.colours()[few.index_of({77, 1, 2})];
  CHECK(std::abs(near[0] - 77) <= 16);
}

TEST_CASE("bad height maps are refused", "[formats]") {
  const Bytes good = png_of_rows(2, 2, 8, PNG_COLOR_TYPE_GRAY, {0, 3, 200, 0});
  CHECK(map_error(png_of_rows(2, 2, 8, PNG_COLOR_TYPE_RGB, Bytes(12))).code ==
        ErrorCode::bad_value);
  CHECK(map_error(good, png_of_rows(2, 1, 8, PNG_COLOR_TYPE_RGB, Bytes(6))).code ==
        ErrorCode::bad_value);
  CHECK(map_error(good, {1, 2, 3}).code == ErrorCode::truncated);
  CHECK(map_error(good, {}, {65'536, 255, ""}).code == ErrorCode::bad_value);
  CHECK(map_error(good, {}, {0, 256, ""}).code == ErrorCode::bad_value);
  CHECK(map_error(good, {}, {0, 0, ""}).code == ErrorCode::bad_value);
  CHECK(std::string(
            map_error(png_of_rows(9, 9, 8, PNG_COLOR_TYPE_GRAY, Bytes(81), PNG_INTERLACE_ADAM7))
                .what) == "png: is interlaced");
  // 16,384 a side: the file is small, and refused before it is decoded.
  Bytes huge = good;
  huge[18] = huge[22] = 0x40;
  CHECK(map_error(huge).code == ErrorCode::limit_exceeded);
  huge[16] = 0xff;
  CHECK(map_error(huge).code == ErrorCode::limit_exceeded);
  // A text that states 84 MB, of which the file has none. (The fuzz corpus has it, too.)
  Bytes long_text = good;
  const Bytes chunk = {5, 5, 5, 7, 't', 'E', 'X', 't'};
  long_text.insert(long_text.begin() + 33, chunk.begin(), chunk.end());
  CHECK(map_error(long_text).code == ErrorCode::bad_value);
  CHECK(lengths_without_error(kHeightMap, good).empty());
  for (std::size_t i = 0; i < good.size(); ++i) {
    Bytes flipped = good;
    flipped[i] ^= 0x10;
    static_cast<void>(read_height_map(flipped, [](ForeignPiece&&) { return Result<void>{}; }));
  }
}

TEST_CASE("a build from above is a height map and a colour map, and their columns are read again",
          "[formats]") {
  SplitMix64 rng{4};
  for (const std::int32_t high : {40, 255, 300}) {
    CAPTURE(high);
    FileBuild build = random_file_build(rng, {140, high, 9}, 5, true);
    const auto heights = written(write_height_map, build);
    const auto colours = written(write_colour_map, build);
    REQUIRE((heights && colours));
    const Columns columns = columns_of(*heights, *colours, {});
    const auto texts = cell_texts(build);
    std::size_t wrong = 0;
    for (std::int32_t z = 0; z < 9; ++z) {
      for (std::int32_t x = 0; x < 140; ++x) {
        std::int32_t y = high;
        const auto text = [&](std::int32_t at) {
          return texts[static_cast<std::size_t>(x + 140 * (at + high * z))];
        };
        while (y > 0 && (text(y - 1) == "-" || text(y - 1) == "air")) --y;
        const auto found = columns.find({x, z});
        const auto size = found == columns.end() ? 0U : found->second.size();
        if (size != static_cast<std::size_t>(y)) ++wrong;
        if (y == 0 || size == 0) continue;
        const std::string top = text(y - 1);
        std::array<unsigned, 3> rgb{};
        std::sscanf(top.c_str() + top.rfind('|') + 1, "%u,%u,%u", &rgb[0], &rgb[1], &rgb[2]);
        char name[20];
        std::snprintf(name, sizeof name, "colour #%02x%02x%02x", rgb[0] & 255, rgb[1] & 255,
                      rgb[2] & 255);
        if (found->second.back() != name) ++wrong;
      }
    }
    CHECK(wrong == 0);
  }
  const FileBuild stone = file_build({1, 1, 1}, {file_material("a", "", {1, 2, 3, 255})},
                                     [](VoxelPos) { return std::uint16_t{1}; });
  for (int allowed = 0; allowed < 4; ++allowed) {
    int calls = 0;
    CHECK(write_height_map(stone, [&](ByteView) { return calls++ < allowed; }).error().code ==
          ErrorCode::io_failed);
  }
  const FileBuild long_build = file_build({8193, 1, 1}, {file_material("a", "", {1, 2, 3, 255})},
                                          [](VoxelPos) { return std::uint16_t{1}; });
  CHECK_FALSE(written(write_height_map, long_build).has_value());
}

TEST_CASE("a build from above shows what is below a plant", "[formats][shapes]") {
  std::vector<BuildMaterial> materials = {file_material("plant", "", {10, 200, 10, 255}),
                                          file_material("stone", "", {1, 2, 3, 255})};
  materials[0].row.shape = {ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
  const FileBuild build = file_build({1, 2, 1}, materials, [](VoxelPos at) {
    return static_cast<std::uint16_t>(at.y == 0 ? 2 : 1);
  });
  const auto heights = written(write_height_map, build);
  const auto colours = written(write_colour_map, build);
  REQUIRE((heights && colours));
  CHECK(columns_of(*heights, *colours, {}) == Columns{{{0, 0}, {"colour #010203"}}});
}

}  // namespace runstone::test
