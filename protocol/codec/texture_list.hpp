// The byte lists of the messages about textures. docs/protocol.md specifies the bytes. Thread: any.
#pragma once
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/core/texture.hpp"
#include "protocol/codec/texture_messages.hpp"

namespace runstone {

/// Requires entries that decode_textures() accepts.
Bytes encode_textures(const std::vector<TextureEntry>& entries);
/// Fails for no entries or more than kTexturesGivenMax, for more than kTexturesGivenUsesMax uses
/// together, and for entries whose size or uses are not valid.
Result<std::vector<TextureEntry>> decode_textures(ByteView bytes);

Bytes encode_hashes(const std::vector<TextureHash>& hashes);
/// Fails unless there are 1 .. kTexturesWantedMax hashes, all different.
Result<std::vector<TextureHash>> decode_hashes(ByteView bytes);

Bytes encode_texture_parts(const std::vector<TexturePart>& parts);
/// Fails unless there are 1 .. kTexturesWantedMax parts of at most kTextureBytesMax.
Result<std::vector<TexturePart>> decode_texture_parts(ByteView bytes);

}  // namespace runstone
