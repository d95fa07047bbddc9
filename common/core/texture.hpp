// Textures: pictures that a world brings for sides of its materials. A picture is a PNG file, known
// by the hash of its bytes. A side of a material has one picture for ever. Materials without a
// picture are drawn with their look.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// BLAKE2b of the bytes of the PNG, 256 bits. It is cryptographic, because clients share what they
/// cache between servers.
using TextureHash = std::array<std::uint8_t, 32>;

/// The bytes of one picture, at most. A picture of kTextureEdgeMax that is not compressed fits.
inline constexpr std::size_t kTextureBytesMax = 24'576;
/// The pixels along a side of a picture: 16, 32 or 64.
inline constexpr std::uint16_t kTextureEdgeMin = 16, kTextureEdgeMax = 64;
/// The pictures of a world, at most. Decoded they take 64 MiB at most.
inline constexpr std::size_t kTextureCountMax = 4096;
/// The bytes of all pictures of a world together, at most.
inline constexpr std::size_t kTexturesBytesMax = std::size_t{16} << 20;
/// The uses of one entry or record, at most. A picture with more uses has several.
inline constexpr std::size_t kTextureUsesMax = 1024;

/// The sides of a material: the bit 1 << d stands for the side whose faces look in Direction d.
inline constexpr std::uint8_t kAllTextureSides = (1U << kDirectionCount) - 1;
constexpr std::uint8_t texture_side(Direction d) {
  return static_cast<std::uint8_t>(1U << static_cast<std::uint8_t>(d));
}

/// The sides of a material that show a picture.
struct TextureUse {
  Material material = kEmpty;  // not empty
  std::uint8_t sides = 0;      // 1 .. kAllTextureSides
  friend bool operator==(const TextureUse&, const TextureUse&) = default;
};

/// A picture without its bytes.
struct TextureEntry {
  TextureHash hash{};
  std::uint32_t bytes = 1;  // of the PNG, 1 .. kTextureBytesMax
  std::vector<TextureUse> uses;
  friend bool operator==(const TextureEntry&, const TextureEntry&) = default;
};

/// Fails unless there are 1 .. kTextureUsesMax uses, whose materials ascend and whose sides are
/// valid. The error's offset is the index of the use. Cost: O(uses).
Result<void> check_texture_uses(const std::vector<TextureUse>& uses);

/// Returns the pixels along a side of the picture, from the head of the PNG. Fails if it is no PNG,
/// if it is not square with an edge of 16, 32 or 64, if a colour has more than 8 bits, or if the
/// file is longer than kTextureBytesMax. The rest is not read: see read_texture(). Cost: O(1).
Result<std::uint16_t> texture_edge(ByteView png);

}  // namespace runstone
