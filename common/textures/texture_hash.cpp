#include "common/textures/texture_hash.hpp"

#include <sodium.h>

#include <utility>

namespace runstone {

static_assert(sizeof(TextureHash) == crypto_generichash_BYTES);

TextureHash texture_hash(ByteView png) {
  TextureHash hash;
  crypto_generichash(hash.data(), hash.size(), png.data(), png.size(), nullptr, 0);
  return hash;
}

TextureEntry texture_entry(ByteView png, std::vector<TextureUse> uses,
                           const std::optional<TextureHash>& hash) {
  return {hash ? *hash : texture_hash(png), static_cast<std::uint32_t>(png.size()),
          std::move(uses)};
}

}  // namespace runstone
