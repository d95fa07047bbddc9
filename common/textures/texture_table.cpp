#include "common/textures/texture_table.hpp"

#include <algorithm>

namespace runstone {

Result<void> TextureTable::check(const TextureEntry& entry) const {
  if (auto sound = check_texture_uses(entry.uses); !sound) return sound;
  if (entry.bytes == 0 || entry.bytes > kTextureBytesMax)
    return fail(ErrorCode::limit_exceeded, "the size of a picture is out of range");
  if (const auto known = find(entry.hash)) {
    if (entries_[*known].bytes != entry.bytes)
      return fail(ErrorCode::bad_value, "one picture has two sizes");
  } else if (entries_.size() == kTextureCountMax) {
    return fail(ErrorCode::limit_exceeded, "the world has 4,096 pictures, which is the most");
  } else if (entry.bytes > kTexturesBytesMax - bytes_) {
    return fail(ErrorCode::limit_exceeded, "the pictures of the world take more than 16 MiB");
  }
  for (const TextureUse& use : entry.uses) {
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
      const auto direction = static_cast<Direction>(side);
      if ((use.sides & texture_side(direction)) != 0 && number(use.material, direction) != 0)
        return fail(ErrorCode::not_permitted, "a side of a material has a picture already",
                    use.material);
    }
  }
  return {};
}

Result<void> TextureTable::add(const TextureEntry& entry) {
  if (auto fits = check(entry); !fits) return fits;
  const auto [at, is_new] =
      index_of_.try_emplace(entry.hash, static_cast<std::uint16_t>(entries_.size()));
  const std::uint16_t index = at->second;
  if (is_new) {
    entries_.push_back(entry);
    bytes_ += entry.bytes;
  } else {
    std::vector<TextureUse>& uses = entries_[index].uses;
    uses.insert(uses.end(), entry.uses.begin(), entry.uses.end());
  }
  numbers_.resize(std::max(numbers_.size(), std::size_t{entry.uses.back().material} + 1));
  for (const TextureUse& use : entry.uses) {
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
      if ((use.sides & texture_side(static_cast<Direction>(side))) != 0)
        numbers_[use.material][side] = static_cast<std::uint16_t>(index + 1);
    }
  }
  return {};
}

Result<void> TextureTable::add(std::span<const TextureEntry> entries) {
  for (const TextureEntry& entry : entries) {
    if (auto added = add(entry); !added) return added;
  }
  return {};
}

std::optional<std::uint16_t> TextureTable::find(const TextureHash& hash) const {
  const auto found = index_of_.find(hash);
  return found == index_of_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace runstone
