// TextureFeed: makes what is drawn of the textures of a session. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "client/render/drawn_textures.hpp"
#include "client/session/texture_exchange.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class TextureFeed {
 public:
  /// While pictures arrive, they are drawn in batches that are this far apart.
  static constexpr TimeUs kBatchUs = 250'000;
  /// The approximate number of pixels that one call of step() prepares.
  static constexpr std::size_t kPixels = 32 * 1024;

  /// Returns the textures to draw from now on, or nullopt if they have not changed. No textures are
  /// drawn if `is_on` is false.
  std::optional<DrawnTexturesPtr> step(const TextureExchange& textures, bool is_on, TimeUs now_us);
  /// Returns a line for the player if something is wrong with the textures of the world, once per
  /// reason and when all pictures have arrived. `left_out`: the pictures for which the graphics
  /// driver has no room.
  std::optional<std::string> take_notice(const TextureExchange& textures, std::size_t left_out);
  /// Returns the bytes of what is drawn, without the copy on the GPU.
  std::size_t bytes() const { return bytes_; }

 private:
  /// Returns a null pointer (draw no textures) if textures were drawn before, otherwise nullopt.
  std::optional<DrawnTexturesPtr> take_nothing();

  std::map<TexturePicturePtr, TextureLevelsPtr> levels_;  // of the pictures that are drawn
  std::size_t bytes_ = 0;                                 // of levels_
  std::uint64_t serial_ = 0;               // TextureExchange::serial() of what was returned last
  bool has_drawn_ = false;                 // what was returned last are textures
  TimeUs drawn_us_ = 0;                    // when it was returned
  std::size_t failed_ = 0, left_out_ = 0;  // of which there was a notice
};

}  // namespace runstone
