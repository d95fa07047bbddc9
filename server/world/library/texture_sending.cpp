#include "server/world/library/texture_sending.hpp"

#include <utility>

namespace runstone {

void TextureSending::encode_next(Wanting& wanting) const {
  const WorldTextures& textures = order_.textures();
  TextureParts message;
  std::size_t bytes = 0;
  while (!wanting.waiting.empty() && message.parts.size() < kTexturesWantedMax) {
    TexturePart part{wanting.waiting.front(), {}};
    const auto index = textures.table().find(part.hash);
    if (index && *index >= wanting.answers.size()) wanting.answers.resize(*index + 1U);
    if (index && wanting.answers[*index] < kTextureAnswersMax) {
      const Bytes& png = textures.png(*index);
      if (bytes != 0 && bytes + png.size() > kTextureMessageBytes) break;
      part.png = png;
      ++wanting.answers[*index];
    }
    bytes += sizeof(TextureHash) + part.png.size();
    wanting.waiting.pop_front();
    message.parts.push_back(std::move(part));
  }
  wanting.unsent_parts = message.parts.size();
  wanting.unsent = encode_message(message);
}

void TextureSending::send(const Session& session, Wanting& wanting, std::size_t count) {
  for (; count > 0 && !wanting.is_answered(); --count) {
    if (!wanting.unsent) encode_next(wanting);
    if (!sessions_.send(session, *wanting.unsent)) return;
    wanting.unsent.reset();
    wanting.unsent_parts = 0;
  }
}

void TextureSending::on_wanted(Session& session, const TexturesWanted& wanted) {
  Wanting& wanting = by_session_[session.id];
  const std::size_t unanswered = wanting.waiting.size() + wanting.unsent_parts;
  if (unanswered + wanted.hashes.size() > kTexturesUnansweredMax) {
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
    if (wanting.is_answered()) continue;
    const Session* const session = std::as_const(sessions_).find(id);
    if (session != nullptr) send(*session, wanting, kPartsAtOnce);
  }
}

}  // namespace runstone
