#include "client/session/texture_exchange.hpp"

#include <algorithm>

#include "common/textures/texture_hash.hpp"

namespace runstone {

static_assert(kTextureCountMax * kTextureEdgeMax * kTextureEdgeMax * 4 <= std::size_t{64} << 20,
              "the pictures of a server take 64 MiB at most");

void TextureExchange::connected(bool has_textures, bool has_cache) {
  has_textures_ = has_textures;
  has_cache_ = has_cache;
  is_list_new_ = true;
  failed_ = 0;
  for (auto& [hash, slot] : slots_) {
    if (slot.state == State::failed) move_to(slot, State::missing);
  }
}

void TextureExchange::disconnected() {
  has_textures_ = false;
  for (auto& [hash, slot] : slots_) {
    if (slot.state == State::asked) move_to(slot, State::missing);
  }
}

void TextureExchange::clear() {
  const std::uint64_t serial = serial_;
  const bool is_wanted = is_wanted_;
  // Each lookup in progress still gets one result.
  auto lookups = std::move(lookups_);
  *this = {};
  lookups_ = std::move(lookups);
  is_wanted_ = is_wanted;
  is_list_new_ = true;
  serial_ = serial + 1;
}

Result<void> TextureExchange::receive(const TexturesGiven& given) {
  if (std::exchange(is_list_new_, false)) table_ = {};
  ++serial_;
  for (const TextureEntry& entry : given.entries) {
    if (auto added = table_.add(entry); !added) return added;
    const auto [at, is_new] = slots_.try_emplace(entry.hash);
    Slot& slot = at->second;
    if (is_new) {
      ++counts_[static_cast<std::size_t>(State::listed)];
      slot.bytes = entry.bytes;
    } else if (slot.bytes != entry.bytes) {
      return fail(ErrorCode::bad_value, "one picture has two sizes");
    }
  }
  if (slots_.size() > kTextureCountMax) forget_unlisted(std::nullopt);
  return {};
}

void TextureExchange::move_to(Slot& slot, State next) {
  --counts_[static_cast<std::size_t>(slot.state)];
  slot.state = next;
  ++counts_[static_cast<std::size_t>(next)];
}

void TextureExchange::forget_unlisted(std::optional<State> state) {
  std::erase_if(slots_, [&](const auto& entry) {
    const bool is_gone = (!state || entry.second.state == *state) && !table_.find(entry.first);
    if (!is_gone) return false;
    --counts_[static_cast<std::size_t>(entry.second.state)];
    if (entry.second.picture) picture_bytes_ -= entry.second.picture->rgba.size();
    return true;
  });
}

std::vector<TextureHash> TextureExchange::take(State from, State next, std::size_t most) {
  std::vector<TextureHash> out;
  if (count(from) == 0) return out;
  // The order is that of the list, because neighbours in the list are often used together.
  for (const TextureEntry& entry : table_.entries()) {
    if (out.size() == most) break;
    Slot& slot = slots_.at(entry.hash);
    if (slot.state != from) continue;
    move_to(slot, next);
    out.push_back(entry.hash);
  }
  // All pictures in this state belong to an earlier list.
  if (out.empty()) forget_unlisted(from);
  return out;
}

std::optional<std::vector<TextureHash>> TextureExchange::take_lookup() {
  if (!asks() || !has_cache_) return std::nullopt;
  std::vector<TextureHash> out = take(State::listed, State::looked_up, kLookupMax);
  if (out.empty()) return std::nullopt;
  lookups_.push_back(out);
  return out;
}

void TextureExchange::receive_cached(std::vector<TexturePart> found) {
  if (lookups_.empty()) return;
  const std::vector<TextureHash> hashes = std::move(lookups_.front());
  lookups_.pop_front();
  const auto slot_of = [this](const TextureHash& hash) {
    const auto at = slots_.find(hash);
    return at != slots_.end() && at->second.state == State::looked_up ? &at->second : nullptr;
  };
  for (TexturePart& part : found) {
    Slot* const slot = slot_of(part.hash);
    if (slot == nullptr) continue;
    move_to(*slot, State::arrived);
    arrived_.push_back({std::move(part), true});
  }
  for (const TextureHash& hash : hashes) {
    if (Slot* const slot = slot_of(hash)) move_to(*slot, State::missing);
  }
}

void TextureExchange::receive(TextureParts answer) {
  for (TexturePart& part : answer.parts) {
    const auto at = slots_.find(part.hash);
    if (at == slots_.end() || at->second.state != State::asked) continue;
    move_to(at->second, State::arrived);
    arrived_.push_back({std::move(part), false});
  }
}

void TextureExchange::decode(Arrival arrival) {
  const TexturePart& part = arrival.part;
  const auto at = slots_.find(part.hash);
  if (at == slots_.end() || at->second.state != State::arrived) return;
  Slot& slot = at->second;
  const bool is_right = part.png.size() == slot.bytes && texture_hash(part.png) == part.hash;
  Result<TexturePicture> picture = failure(Error{});
  if (is_right) picture = read_texture(part.png);
  if (!picture) {
    // The row in the cache may be damaged, so the picture is requested from the server.
    move_to(slot, arrival.is_from_cache ? State::missing : State::failed);
    failed_ += arrival.is_from_cache ? 0U : 1U;
    return;
  }
  slot.picture = std::make_shared<const TexturePicture>(*std::move(picture));
  picture_bytes_ += slot.picture->rgba.size();
  move_to(slot, State::here);
  ++serial_;
  if (has_cache_ && !arrival.is_from_cache) for_cache_.push_back(std::move(arrival.part));
}

std::vector<Message> TextureExchange::step() {
  for (std::size_t bytes = 0; !arrived_.empty() && bytes < kDecodeBytes;) {
    Arrival next = std::move(arrived_.front());
    arrived_.pop_front();
    bytes += next.part.png.size() + 1;
    decode(std::move(next));
  }
  std::vector<Message> out;
  // A client sends the next request when all hashes of the last one were answered.
  if (!asks() || count(State::asked) != 0) return out;
  const State unasked = has_cache_ ? State::missing : State::listed;
  TexturesWanted wanted{take(unasked, State::asked, kTexturesWantedMax)};
  if (wanted.hashes.empty() && !has_cache_)
    wanted.hashes = take(State::missing, State::asked, kTexturesWantedMax);
  if (!wanted.hashes.empty()) out.emplace_back(std::move(wanted));
  return out;
}

TexturePicturePtr TextureExchange::picture(const TextureHash& hash) const {
  const auto at = slots_.find(hash);
  return at == slots_.end() ? nullptr : at->second.picture;
}

bool TextureExchange::is_loading() const {
  if (count(State::arrived) != 0) return true;
  return asks() && count(State::here) + count(State::failed) != slots_.size();
}

}  // namespace runstone
