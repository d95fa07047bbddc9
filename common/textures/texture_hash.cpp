#include "common/textures/texture_hash.hpp"

#include <sodium.h>

namespace runstone {

static_assert(sizeof(TextureHash) == crypto_generichash_BYTES);

TextureHash texture_hash(ByteView png) {
  TextureHash hash;
  crypto_generichash(hash.data(), hash.size(), png.data(), png.size(), nullptr, 0);
  return hash;
}

}  // namespace runstone
