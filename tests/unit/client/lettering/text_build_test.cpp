#include "client/lettering/text_build.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <catch2/catch.hpp>
#include <cstdint>
#include <set>
#include <utility>

#include "client/lettering/font_file.hpp"
#include "common/core/hash.hpp"

namespace runstone::test {
namespace {

const Bytes& font() {
  static const FontPtr read = read_font(kDefaultFont).value();
  return *read;
}

std::string refusal(std::string_view text, const TextStyle& style = {}) {
  const auto made = text_build(font(), text, style, 1);
  return made ? std::string() : made.error();
}

/// Draws a text of ASCII pixel by pixel: the places of its pixels, from the lowest along each axis.
std::set<std::pair<int, int>> drawn(const char* text, int height) {
  FT_Library library = nullptr;
  REQUIRE(FT_Init_FreeType(&library) == 0);
  FT_Face face = nullptr;
  REQUIRE(FT_New_Memory_Face(library, font().data(), static_cast<FT_Long>(font().size()), 0,
                             &face) == 0);
  REQUIRE(FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(height)) == 0);
  std::set<std::pair<int, int>> pixels;
  int pen = 0, low_x = INT32_MAX, low_y = INT32_MAX;
  for (; *text != 0; ++text) {
    REQUIRE(FT_Load_Char(face, static_cast<FT_ULong>(*text),
                         FT_LOAD_RENDER | FT_LOAD_TARGET_MONO) == 0);
    const FT_GlyphSlot slot = face->glyph;
    for (unsigned row = 0; row < slot->bitmap.rows; ++row) {
      for (unsigned x = 0; x < slot->bitmap.width; ++x) {
        const unsigned byte =
            slot->bitmap.buffer[row * static_cast<unsigned>(slot->bitmap.pitch) + x / 8];
        if ((byte >> (7 - x % 8) & 1U) == 0) continue;
        const int px = pen + slot->bitmap_left + static_cast<int>(x);
        const int py = slot->bitmap_top - 1 - static_cast<int>(row);
        pixels.emplace(px, py);
        low_x = std::min(low_x, px);
        low_y = std::min(low_y, py);
      }
    }
    pen += static_cast<int>(slot->advance.x >> 6);
  }
  FT_Done_FreeType(library);
  std::set<std::pair<int, int>> out;
  for (const auto& [x, y] : pixels) out.emplace(x - low_x, y - low_y);
  return out;
}

}  // namespace

TEST_CASE("a text has the pixels of its letters, in each layer", "[lettering]") {
  const int height = GENERATE(5, 16, 70);
  const int thickness = GENERATE(1, 3);
  const char* const text = "Runstone, jgy!";
  const auto build = text_build(font(), text, {height, thickness}, 6);
  REQUIRE(build);
  const auto expected = drawn(text, height);
  const VoxelPos sides = (*build)->sides();
  CHECK(sides.z == thickness);
  CHECK((*build)->touched() == expected.size() * static_cast<std::size_t>(thickness));
  std::size_t wrong = 0;
  for (std::int32_t z = 0; z < sides.z; ++z) {
    for (std::int32_t y = 0; y < sides.y; ++y) {
      for (std::int32_t x = 0; x < sides.x; ++x) {
        if ((*build)->at({x, y, z}).has_value() != expected.contains({x, y})) ++wrong;
      }
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("bad texts are refused with words", "[lettering]") {
  CHECK(refusal("") == "type a text first");
  CHECK(refusal("a\nb") == "the text must be in UTF-8 without control characters");
  CHECK(refusal("a\xff") == "the text must be in UTF-8 without control characters");
  CHECK(refusal("a\u202e b") == "the text has a character that cannot be seen");
  CHECK(refusal("   ") == "the text has no voxel: it has blanks only");
  CHECK(refusal("\U00013000") == "the font has no letter for U+13000");
  CHECK(refusal(std::string(257, 'a')) == "a text has at most 256 characters");
  CHECK(refusal(std::string(256, 'W'), {256, 1}) ==
        "the text is longer than 4,096 voxels: choose a smaller height");
  CHECK(refusal(std::string(256, 'i'), {5, 64}).empty());
  CHECK(refusal("Größe Ωмир").empty());
}

TEST_CASE("damaged fonts are refused or drawn, and never read beyond their bytes", "[lettering]") {
  CHECK_FALSE(text_build({}, "a", {}, 1));
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 60; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    Bytes damaged = font();
    const auto size = static_cast<std::uint32_t>(damaged.size());
    if (round % 2 == 0) damaged.resize(rng.below(size));
    for (int i = 0; i < 400 && !damaged.empty(); ++i)
      damaged[rng.below(static_cast<std::uint32_t>(damaged.size()))] =
          static_cast<std::uint8_t>(rng.below(256));
    const auto made = text_build(damaged, "Ag", {}, 1);
    if (made) CHECK((*made)->sides().x <= kTextLengthMax + 200);
  }
}

TEST_CASE("a font is found by its name or its path, and a missing one is named", "[lettering]") {
  CHECK(read_font("DejaVuSans.ttf"));
  CHECK(read_font("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"));
  const auto by_name = read_font("NoSuchFont");
  REQUIRE_FALSE(by_name);
  CHECK(by_name.error().starts_with("there is no font NoSuchFont: looked for NoSuchFont.ttf"));
  const auto by_path = read_font("/nowhere/a.ttf");
  REQUIRE_FALSE(by_path);
  CHECK(by_path.error().find("/nowhere/a.ttf") != std::string::npos);
}

}  // namespace runstone::test
