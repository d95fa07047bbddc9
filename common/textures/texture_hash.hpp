// The hash by which a picture is known.
#pragma once
#include <optional>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/texture.hpp"

namespace runstone {

/// Returns the hash of the bytes of a PNG. Cost: O(bytes). Thread: any.
TextureHash texture_hash(ByteView png);

/// Returns the entry of a picture of at most kTextureBytesMax bytes with these uses. `hash` is the
/// hash of the picture, if it is known already.
TextureEntry texture_entry(ByteView png, std::vector<TextureUse> uses,
                           const std::optional<TextureHash>& hash = std::nullopt);

}  // namespace runstone
