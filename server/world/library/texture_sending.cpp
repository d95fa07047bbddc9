#include "server/world/library/texture_sending.hpp"

#include <utility>

namespace runstone {

TextureParts TextureSending::next_parts(const Wanting& wanting) const {
  const WorldTextures& textures = order_.textures();
  TextureParts message;
  std::size_t bytes = 0;
  for (const TextureHash& hash : wanting.waiting) {
    if (message.parts.size() == kTexturesWantedMax) break;
    TexturePart part{hash, {}};
    const auto index = textures.table().find(hash);
    const bool is_sent =
        index && (*index >= wanting.answers.size() || wanting.answers[*index] < kTextureAnswersMax);
    if (is_sent) {
      const Bytes& png = textures.png(*index);
      if (bytes != 0 && bytes + png.size() > kTextureMessageBytes) break;
      part.png = png;
    }
    bytes += sizeof(TextureHash) + part.png.size();
    message.parts.push_back(std::move(part));
  }
  return message;
}

void TextureSending::send(const Session& session, Wanting& wanting, std::size_t count) {
  for (; count > 0 && !wanting.waiting.empty(); --count) {
    const TextureParts message = next_parts(wanting);
    if (!sessions_.send(session, encode_message(message))) return;
    for (const TexturePart& part : message.parts) {
      wanting.waiting.pop_front();
      if (part.png.empty()) continue;
      const std::size_t index = *order_.textures().table().find(part.hash);
      if (index >= wanting.answers.size()) wanting.answers.resize(index + 1);
      ++wanting.answers[index];
    }
  }
}

void TextureSending::on_wanted(Session& session, const TexturesWanted& wanted) {
  Wanting& wanting = by_session_[session.id];
  if (wanting.waiting.size() + wanted.hashes.size() > kTexturesUnansweredMax) {
    return sessions_.close(session, GoodbyeReason::flooding,
                           "more textures are wanted than may be unanswered");
  }
  sessions_.charge_reading(session, wanted.hashes.size() * kWantedTextureBytes);
  wanting.waiting.insert(wanting.waiting.end(), wanted.hashes.begin(), wanted.hashes.end());
  send(session, wanting, kPartsAtOnce);
}

void TextureSending::drained(const Session& session) {
  const auto found = by_session_.find(session.id);
  if (found != by_session_.end()) send(session, found->second, 1);
}

void TextureSending::tick() {
  for (auto& [id, wanting] : by_session_) {
    if (wanting.waiting.empty()) continue;
    const Session* const session = std::as_const(sessions_).find(id);
    if (session != nullptr) send(*session, wanting, kPartsAtOnce);
  }
}

}  // namespace runstone
