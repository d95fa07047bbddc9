// The hash by which a picture is known.
#pragma once
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/texture.hpp"

namespace runstone {

/// Returns the hash of the bytes of a PNG. Cost: O(bytes). Thread: any.
TextureHash texture_hash(ByteView png);

/// Returns the entry of a picture of at most kTextureBytesMax bytes with these uses.
TextureEntry texture_entry(ByteView png, std::vector<TextureUse> uses);

}  // namespace runstone
