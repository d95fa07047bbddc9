// WebTextures: the texture cache of the browser client. The page keeps the pictures in IndexedDB
// (page/textures.js) by their hash; all servers share them. A picture may be damaged: the reader
// checks the hash (TextureExchange). If IndexedDB fails, nothing is found. Thread: the page's only
// one. Calls return at once; the page calls found() and looked_up() later.
#pragma once
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/texture.hpp"
#include "protocol/codec/texture_messages.hpp"

namespace runstone {

class WebTextures {
 public:
  void look_up_textures(std::vector<TextureHash> hashes);
  /// Returns the results of lookups since the last call, in order: the pictures that were found.
  std::vector<std::vector<TexturePart>> drain_textures() { return std::exchange(results_, {}); }
  void keep_textures(const std::vector<TexturePart>& parts);

  // Calls of the page.
  /// Takes the picture of a hash of the oldest lookup. `index`: the place of the hash in the
  /// lookup.
  void found(std::size_t index, ByteView png);
  /// Ends the oldest lookup.
  void looked_up();

 private:
  struct OpenLookup {
    std::vector<TextureHash> hashes;
    std::vector<TexturePart> found;
  };
  std::deque<OpenLookup> lookups_;
  std::vector<std::vector<TexturePart>> results_;
};

}  // namespace runstone
