// The hash by which a picture is known.
#pragma once
#include "common/core/bytes.hpp"
#include "common/core/texture.hpp"

namespace runstone {

/// Returns the hash of the bytes of a PNG. Cost: O(bytes). Thread: any.
TextureHash texture_hash(ByteView png);

}  // namespace runstone
