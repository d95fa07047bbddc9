#include "client/play/texture_feed.hpp"

#include <algorithm>
#include <utility>

namespace runstone {
namespace {

std::string not_drawn(std::size_t count) {
  return std::to_string(count) +
         (count == 1 ? " texture of this world is" : " textures of this world are") +
         " not drawn: ";
}

}  // namespace

std::optional<DrawnTexturesPtr> TextureFeed::step(const TextureExchange& textures, bool is_on,
                                                  TimeUs now_us) {
  if (!is_on) {
    levels_.clear();
    bytes_ = 0;
    serial_ = 0;
    return take_nothing();
  }
  if (serial_ == textures.serial()) return std::nullopt;
  if (has_drawn_ && textures.is_loading() && now_us - drawn_us_ < kBatchUs) return std::nullopt;
  auto drawn = std::make_shared<DrawnTextures>();
  std::map<TexturePicturePtr, TextureLevelsPtr> used;
  std::size_t pixels = 0;
  bool is_any = false;
  for (const TextureEntry& entry : textures.table().entries()) {
    TextureLevelsPtr levels;
    if (const TexturePicturePtr picture = textures.picture(entry.hash)) {
      const auto known = levels_.find(picture);
      if (known != levels_.end()) {
        levels = known->second;
      } else if (pixels < kPixels) {
        levels = std::make_shared<const TextureLevels>(texture_levels(*picture));
        pixels += std::size_t{picture->edge} * picture->edge;
      }
      if (levels) used.emplace(picture, levels);
      is_any = is_any || levels;
    }
    drawn->pictures.push_back(std::move(levels));
  }
  levels_ = std::move(used);
  bytes_ = 0;
  for (const auto& [picture, levels] : levels_) {
    for (const std::vector<std::uint8_t>& level : levels->levels) bytes_ += level.size();
  }
  // The next call prepares the rest of the pictures.
  if (pixels >= kPixels) return std::nullopt;
  serial_ = textures.serial();
  if (!is_any) return take_nothing();
  drawn->table = std::make_shared<const TextureTable>(textures.table());
  has_drawn_ = true;
  drawn_us_ = now_us;
  return drawn;
}

std::optional<DrawnTexturesPtr> TextureFeed::take_nothing() {
  if (!std::exchange(has_drawn_, false)) return std::nullopt;
  return DrawnTexturesPtr();
}

std::optional<std::string> TextureFeed::take_notice(const TextureExchange& textures,
                                                    std::size_t left_out) {
  const std::size_t failed = textures.failed();
  // Another world or connection begins with none, also while its pictures are on their way.
  left_out_ = std::min(left_out_, left_out);
  failed_ = std::min(failed_, failed);
  if (textures.is_loading()) return std::nullopt;
  if (std::exchange(left_out_, left_out) < left_out)
    return not_drawn(left_out) + "the graphics driver has no room for more";
  if (std::exchange(failed_, failed) < failed)
    return not_drawn(failed) + "the server sent other bytes than it announced, or no pictures";
  return std::nullopt;
}

}  // namespace runstone
