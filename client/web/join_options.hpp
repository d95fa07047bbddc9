// JoinOptions: the options that the page gives to the browser client when the player joins.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/render/frame_look.hpp"
#include "client/replica/cache_lookup.hpp"
#include "protocol/codec/handshake.hpp"

namespace runstone {

struct JoinOptions {
  std::string url;                                  // of the WebSocket: ws:// or wss://
  std::string name;                                 // shown to others
  std::string ticket;                               // an invite; empty: none
  KeySeed seed{};                                   // the identity; it must stay secret
  bool is_key_kept = false;                         // the browser keeps the key for later visits
  std::map<WorldId, PublicKey> pinned;              // server keys seen before
  std::uint8_t view_radius = 6, view_radius_v = 3;  // chunks
  std::uint8_t far_levels = 3;
  std::size_t memory_mib = 512;
  std::optional<Quality> quality;  // nullopt: automatic
  bool shows_textures = true;      // the pictures that the world brings for its materials
  bool has_cache = false;          // the page keeps chunks
  /// The worlds of which the page has chunks, as their servers described them last.
  std::vector<CachedWorld> cached_worlds;
};

}  // namespace runstone
