#include "client/lettering/text_build.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cstdio>
#include <memory>
#include <type_traits>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "common/sculpt/row_build.hpp"

namespace runstone {
namespace {

/// A letter of a sound font reaches at most so many heights from its place.
constexpr std::int32_t kReachHeights = 4;
constexpr const char* kBadLetter = "the font has letters of a size that cannot be";

struct LibraryEnd {
  void operator()(FT_Library library) const { FT_Done_FreeType(library); }
};
struct FaceEnd {
  void operator()(FT_Face face) const { FT_Done_Face(face); }
};
using LibraryHandle = std::unique_ptr<std::remove_pointer_t<FT_Library>, LibraryEnd>;
using FaceHandle = std::unique_ptr<std::remove_pointer_t<FT_Face>, FaceEnd>;

/// The pixels of a line of text, by height above the lowest place that a letter may reach.
struct TextPixels {
  std::vector<std::vector<RowStretch>> rows;
  std::int32_t low = 0, high = 0;  // along the text
};

std::string name_of_character(std::uint32_t character) {
  char out[16];
  std::snprintf(out, sizeof(out), "U+%04X", static_cast<unsigned>(character));
  return out;
}

/// Loads a letter into the slot of the face and draws it there with one bit a pixel. Returns false
/// if it has no outline, cannot be drawn, or reaches farther than `reach` pixels.
bool draw_letter(FT_Face face, FT_UInt glyph, std::int32_t reach) {
  if (FT_Load_Glyph(face, glyph, FT_LOAD_TARGET_MONO | FT_LOAD_NO_BITMAP) != 0) return false;
  FT_GlyphSlot slot = face->glyph;
  if (slot->format != FT_GLYPH_FORMAT_OUTLINE) return false;
  // The bitmap is allocated by these bounds, so they are checked before.
  FT_BBox box{};
  FT_Outline_Get_CBox(&slot->outline, &box);
  const FT_Pos reach_26_6 = FT_Pos{reach} * 64;
  if (box.xMin < -reach_26_6 || box.yMin < -reach_26_6 || box.xMax > reach_26_6 ||
      box.yMax > reach_26_6 || slot->advance.x < 0 || slot->advance.x > reach_26_6)
    return false;
  return FT_Render_Glyph(slot, FT_RENDER_MODE_MONO) == 0 &&
         slot->bitmap.pixel_mode == FT_PIXEL_MODE_MONO && slot->bitmap.pitch >= 0;
}

/// Adds the letter in the slot, which stands at `pen`. Returns false if it lies outside the rows.
bool add_letter(const FT_GlyphSlot slot, std::int32_t pen, std::int32_t reach, TextPixels& out) {
  const FT_Bitmap& bitmap = slot->bitmap;
  const auto width = static_cast<std::int32_t>(bitmap.width);
  for (std::int32_t row = 0; row < static_cast<std::int32_t>(bitmap.rows); ++row) {
    const std::int32_t y = slot->bitmap_top - 1 - row + reach;
    if (y < 0 || y >= static_cast<std::int32_t>(out.rows.size())) return false;
    const unsigned char* const bits = bitmap.buffer + std::ptrdiff_t{row} * bitmap.pitch;
    const auto is_set = [&](std::int32_t x) { return (bits[x / 8] >> (7 - x % 8) & 1) != 0; };
    for (std::int32_t x = 0; x < width; ++x) {
      if (!is_set(x)) continue;
      const std::int32_t first = x;
      while (x < width && is_set(x)) ++x;
      const std::int32_t left = pen + slot->bitmap_left;
      out.rows[static_cast<std::size_t>(y)].push_back({left + first, left + x});
      out.low = std::min(out.low, left + first);
      out.high = std::max(out.high, left + x);
    }
  }
  return true;
}

Result<TextPixels, std::string> draw_text(ByteView font, std::string_view text,
                                          std::int32_t height) {
  FT_Library opened = nullptr;
  if (FT_Init_FreeType(&opened) != 0) return failure("FreeType does not start");
  const LibraryHandle library(opened);
  FT_Face read = nullptr;
  if (FT_New_Memory_Face(library.get(), font.data(), static_cast<FT_Long>(font.size()), 0, &read) !=
      0)
    return failure("the file is no font, or is damaged");
  const FaceHandle face(read);
  if (!FT_IS_SCALABLE(face.get()) ||
      FT_Set_Pixel_Sizes(face.get(), 0, static_cast<FT_UInt>(height)))
    return failure("the font has letters of fixed sizes only");
  const std::int32_t reach = kReachHeights * height;
  TextPixels out;
  out.rows.resize(static_cast<std::size_t>(2 * reach + 1));
  out.low = kTextLengthMax;
  std::int32_t pen = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::uint32_t character = next_character(text, at);
    const FT_UInt glyph = FT_Get_Char_Index(face.get(), character);
    if (glyph == 0) return failure("the font has no letter for " + name_of_character(character));
    if (!draw_letter(face.get(), glyph, reach) || !add_letter(face->glyph, pen, reach, out))
      return failure(std::string(kBadLetter));
    pen += static_cast<std::int32_t>((face->glyph->advance.x + 32) / 64);
    if (out.high - out.low > kTextLengthMax || pen > kTextLengthMax)
      return failure("the text is longer than 4,096 voxels: choose a smaller height");
  }
  return out;
}

}  // namespace

Result<void, std::string> check_text(std::string_view text) {
  if (text.empty()) return failure("type a text first");
  if (!is_printable_utf8(text))
    return failure("the text must be in UTF-8 without control characters");
  if (has_unseen_character(text)) return failure("the text has a character that cannot be seen");
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size(); next_character(text, at)) ++count;
  if (count > kTextCharactersMax) return failure("a text has at most 256 characters");
  return {};
}

Result<BuildPtr, std::string> text_build(ByteView font, std::string_view text,
                                         const TextStyle& style, Material material) {
  RUNSTONE_ASSERT(style.height >= kTextHeightMin && style.height <= kTextHeightMax);
  RUNSTONE_ASSERT(style.thickness >= kTextThicknessMin && style.thickness <= kTextThicknessMax);
  if (const auto ok = check_text(text); !ok) return failure(ok.error());
  auto drawn = draw_text(font, text, style.height);
  if (!drawn) return failure(drawn.error());
  auto& rows = drawn->rows;
  const auto is_used = [](const std::vector<RowStretch>& row) { return !row.empty(); };
  const auto lowest = std::find_if(rows.begin(), rows.end(), is_used);
  if (lowest == rows.end()) return failure("the text has no voxel: it has blanks only");
  rows.erase(std::find_if(rows.rbegin(), rows.rend(), is_used).base(), rows.end());
  rows.erase(rows.begin(), lowest);
  for (auto& row : rows) {
    for (RowStretch& part : row) part = {part.low - drawn->low, part.high - drawn->low};
    join_stretches(row);
  }
  // The axis along which all layers are equal is z.
  const VoxelPos upright{drawn->high - drawn->low, style.thickness,
                         static_cast<std::int32_t>(rows.size())};
  auto build = build_of_rows(upright, Axis::z, material,
                             [&](std::int32_t, std::int32_t y, std::vector<RowStretch>& out) {
                               out = rows[static_cast<std::size_t>(y)];
                             });
  if (!build) return failure(std::string(build.error().what));
  return *std::move(build);
}

}  // namespace runstone
