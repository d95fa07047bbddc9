// The messages by which a client gets the textures of the world (feature bit 20).
#pragma once
#include <cstddef>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/texture.hpp"

namespace runstone {

/// Pictures that the world has, or uses of pictures that were given before. It has the class of the
/// edits, and follows the materials. After Welcome the whole list comes in several of these
/// messages; without textures none comes.
struct TexturesGiven {
  std::vector<TextureEntry> entries;  // 1 .. kTexturesGivenMax, each with valid uses
  friend bool operator==(const TexturesGiven&, const TexturesGiven&) = default;
};

/// Asks for pictures. Each hash is answered in a TextureParts. A client sends the next message when
/// all hashes of the last one were answered. A server allows kTexturesUnansweredMax unanswered
/// hashes.
struct TexturesWanted {
  std::vector<TextureHash> hashes;  // 1 .. kTexturesWantedMax, all different
  friend bool operator==(const TexturesWanted&, const TexturesWanted&) = default;
};

struct TexturePart {
  TextureHash hash{};
  Bytes png;  // at most kTextureBytesMax; empty: the server does not send the picture
  friend bool operator==(const TexturePart&, const TexturePart&) = default;
};

/// Answers a TexturesWanted, in several messages, in the order in which the hashes were wanted. The
/// codec does not check that the bytes have the hash and are a picture.
struct TextureParts {
  std::vector<TexturePart>
      parts;  // 1 .. kTexturesWantedMax, together kTexturePartsBytesMax at most
  friend bool operator==(const TextureParts&, const TextureParts&) = default;
};

}  // namespace runstone
