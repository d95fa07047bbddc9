// Text build: a line of text as voxels of one material.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/builds/build.hpp"
#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The characters of a text, at most.
inline constexpr std::size_t kTextCharactersMax = 256;
/// The range of the height of letters, in voxels.
inline constexpr std::int32_t kTextHeightMin = 5, kTextHeightMax = 256;
/// The range of the thickness of letters, in voxels.
inline constexpr std::int32_t kTextThicknessMin = 1, kTextThicknessMax = 64;
/// The voxels along a text, at most.
inline constexpr std::int32_t kTextLengthMax = 4096;

struct TextStyle {
  std::int32_t height =
      16;  // the size of the font: capital letters have about three quarters of it
  std::int32_t thickness = 1;  // voxels
};

/// Returns the text upright: it runs along x, its letters rise along y, and it is read from +z. The
/// box is that of the voxels of the letters. Each letter is one of the font, drawn without smooth
/// edges; letters follow each other from left to right. `font` has the bytes of a font file of any
/// format that FreeType reads, and may come from anywhere. Fails with words for the player if
///   - the text is empty, longer than kTextCharactersMax, or not in UTF-8, or if it has control
///     characters or other characters that cannot be seen;
///   - the font cannot be read, lacks a character, or has letters of another size;
///   - the text has no voxel, or is longer than kTextLengthMax voxels.
/// Requires a style within the ranges above. Cost: O(pixels of the letters * thickness / 8).
Result<BuildPtr, std::string> text_build(ByteView font, std::string_view text,
                                         const TextStyle& style, Material material);

/// Fails with words for the player if text_build() refuses a text whatever the font is.
Result<void, std::string> check_text(std::string_view text);

}  // namespace runstone
