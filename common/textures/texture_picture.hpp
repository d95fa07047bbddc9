// TexturePicture: the pixels of a texture, decoded from the PNG that a stranger gave.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

struct TexturePicture {
  std::uint16_t edge = 0;          // 16, 32 or 64
  std::vector<std::uint8_t> rgba;  // edge * edge pixels of four bytes, sRGB, the upper row first
  friend bool operator==(const TexturePicture&, const TexturePicture&) = default;
};

/// Decodes a PNG. Fails if texture_edge() fails, before anything is decoded, and if the picture is
/// damaged. Memory: at most 1 MiB for a moment, whatever the bytes are. Thread: any.
Result<TexturePicture> read_texture(ByteView png);

}  // namespace runstone
