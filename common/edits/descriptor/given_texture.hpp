// GivenTexture: a picture that a record of the log gives to sides of materials of the world.
// docs/edit-log.md specifies the bytes.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/core/texture.hpp"

namespace runstone {

struct GivenTexture {
  Bytes png;                     // for which texture_edge() succeeds
  std::vector<TextureUse> uses;  // as check_texture_uses() demands
  /// texture_hash() of the PNG, if it is known already. No byte of the record has it.
  std::optional<TextureHash> hash = std::nullopt;
  friend bool operator==(const GivenTexture& a, const GivenTexture& b) {
    return a.png == b.png && a.uses == b.uses;
  }
};

/// The maximum size of the bytes: the PNG and its length, and of each use the step from the
/// material before, and the sides.
inline constexpr std::size_t kGivenTextureBytesMax =
    3 + kTextureBytesMax + 2 + kTextureUsesMax * (3 + 1);

/// Fails if the head of the PNG or the uses are not valid. That the rest of the PNG decodes is
/// checked by the server before it orders the record. Cost: O(uses).
Result<void> validate(const GivenTexture& given);

/// Appends the canonical bytes. Requires validate().
void write_given_texture(ByteWriter& w, const GivenTexture& given);
/// Reads what write_given_texture() wrote. A failure is found in the reader. The result is not
/// validated. Memory: O(bytes).
GivenTexture read_given_texture(ByteReader& r);

}  // namespace runstone
