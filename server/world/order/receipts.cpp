#include "server/world/order/receipts.hpp"

#include <algorithm>
#include <utility>

namespace runstone {
namespace {

// A session with more pending rejects does not read at all.
constexpr std::size_t kPendingRejectsMax = 4096;

/// Returns the rows of the table from `first` on, as many as one record may have. The shapes follow
/// in messages of their own.
MaterialsAdded rows_from(const MaterialTable& table, std::size_t first) {
  const auto rows = table.rows().subspan(first, std::min(table.size() - first, kAddedMaterialsMax));
  MaterialsAdded message;
  message.first = static_cast<Material>(first);
  for (const MaterialInfo& info : rows) {
    message.rows.push_back(row_of(info));
    message.rows.back().shape = {};
  }
  return message;
}

}  // namespace

void Receipts::welcomed(const Session& session, const Welcome& welcome) {
  Sent& sent = sent_[session.id];
  sent.epoch = welcome.epoch;
  sent.durable = welcome.durable;
  sent.materials = welcome.materials.size();
  sent.shaped = order_.shaped().size();
}

void Receipts::reject(Session& session, Reject reject) {
  if (session.is_closed) return;
  std::vector<Reject>& pending = sent_[session.id].rejects;
  pending.push_back(std::move(reject));
  if (pending.size() == 1) {
    send_pending(session);
  } else if (pending.size() > kPendingRejectsMax) {
    sessions_.close_slow(session);
  }
}

void Receipts::send_pending(Session& session) {
  if (session.is_closed) return;
  Sent& sent = sent_[session.id];
  std::size_t count = 0;
  while (count < sent.rejects.size() &&
         sessions_.send_or_skip(session, encode_message(sent.rejects[count])))
    ++count;
  sent.rejects.erase(sent.rejects.begin(),
                     sent.rejects.begin() + static_cast<std::ptrdiff_t>(count));
  const bool is_due = sent.durable < order_.durable() && sent.durable < sent.awaits_durable;
  if (is_due && lacks_durable(session, sent)) send_durable({&session.id, 1});
}

bool Receipts::has_pending(const Session& session) const {
  const auto found = sent_.find(session.id);
  return found != sent_.end() && !found->second.rejects.empty();
}

void Receipts::expect_durable(const Session& session, Sequence seq) {
  Sequence& awaited = sent_[session.id].awaits_durable;
  awaited = std::max(awaited, seq);
}

bool Receipts::lacks_durable(const Session& session, const Sent& sent) const {
  if (session.is_closed || session.is_relayed || !sent.rejects.empty()) return false;
  return sent.durable != order_.durable() || sent.is_read_only != order_.is_disk_full();
}

void Receipts::send_durable(std::span<const SessionId> sessions) {
  if (sessions.empty()) return;
  const std::vector<SessionId> full = sessions_.send_to_all(sessions, encode_message(durable()));
  for (const SessionId session : sessions) {
    if (std::ranges::binary_search(full, session)) continue;
    Sent& sent = sent_[session];
    sent.durable = order_.durable();
    sent.is_read_only = order_.is_disk_full();
  }
}

void Receipts::send_durable_to_authors() {
  std::vector<SessionId> authors;
  for (const Session* session : sessions_.open()) {
    const Sent& sent = sent_[session->id];
    if (sent.durable < sent.awaits_durable && lacks_durable(*session, sent))
      authors.push_back(session->id);
  }
  send_durable(authors);
}

void Receipts::broadcast_durable(const Clocks& now) {
  if (now.steady_us < durable_due_us_) return;
  durable_due_us_ = now.steady_us + config_.durable_interval_us;
  std::vector<SessionId> all;
  for (const Session* session : sessions_.open()) {
    if (lacks_durable(*session, sent_[session->id])) all.push_back(session->id);
  }
  send_durable(all);
}

void Receipts::send_epoch(Session& session) {
  if (session.is_closed || session.is_relayed) return;
  Sent& sent = sent_[session.id];
  if (sent.epoch == order_.epoch()) return;
  sent.epoch = order_.epoch();
  if (!session.has(kFeatureResume))
    return sessions_.close(session, GoodbyeReason::closing, kConnectAgain);
  // It precedes the commits of the epoch, which the client would refuse otherwise.
  if (!sessions_.send(session, encode_message(durable()))) sessions_.close_slow(session);
}

void Receipts::send_epoch_to_all() {
  for (Session* session : sessions_.open()) send_epoch(*session);
}

void Receipts::send_materials(Session& session) {
  News news;
  send_materials(session, news);
}

void Receipts::send_materials_to_all() {
  News news;
  for (Session* session : sessions_.open()) send_materials(*session, news);
}

void Receipts::send_materials(Session& session, News& news) {
  if (session.is_closed || session.is_relayed) return;
  Sent& sent = sent_[session.id];
  if (sent.materials != order_.materials().size()) {
    if (!session.has(kFeatureMaterials)) {
      return sessions_.close(session, GoodbyeReason::closing,
                             "the world has new materials: connect again");
    }
    const auto [rows, is_new] = news.rows.try_emplace(sent.materials);
    if (is_new) rows->second = messages_of_rows(sent.materials);
    if (!send_news(session, rows->second)) return;
    sent.materials = order_.materials().size();
  }
  if (sent.shaped != order_.shaped().size() && session.has(kFeatureShapes)) {
    const auto [shapes, is_new] = news.shapes.try_emplace(sent.shaped);
    if (is_new) shapes->second = messages_of_shapes(sent.shaped);
    if (!send_news(session, shapes->second)) return;
    sent.shaped = order_.shaped().size();
  }
  const std::size_t given = order_.textures().given().size();
  if (sent.textures != given && session.has(kFeatureTextures)) {
    const auto [textures, is_new] = news.textures.try_emplace(sent.textures);
    if (is_new) textures->second = messages_of_textures(sent.textures);
    if (!send_news(session, textures->second)) return;
    sent.textures = given;
  }
}

bool Receipts::send_news(Session& session, const std::vector<EncodedMessage>& messages) {
  return std::ranges::all_of(messages, [&](const EncodedMessage& message) {
    return sessions_.send_or_close(session, message);
  });
}

std::vector<EncodedMessage> Receipts::messages_of_rows(std::size_t known) const {
  std::vector<EncodedMessage> out;
  while (known < order_.materials().size()) {
    const MaterialsAdded message = rows_from(order_.materials(), known);
    out.push_back(encode_message(message));
    known += message.rows.size();
  }
  return out;
}

std::vector<EncodedMessage> Receipts::messages_of_shapes(std::size_t known) const {
  std::vector<GivenShape> rows;
  for (const Material material : order_.shaped().subspan(known))
    rows.push_back({material, order_.materials()[material].shape});
  std::ranges::sort(rows, {}, &GivenShape::material);
  std::vector<EncodedMessage> out;
  for (std::span<const GivenShape> left(rows); !left.empty();) {
    const ShapesGiven message{first_of(left)};
    out.push_back(encode_message(message));
    left = left.subspan(message.given.rows.size());
  }
  return out;
}

std::vector<EncodedMessage> Receipts::messages_of_textures(std::size_t known) const {
  std::vector<EncodedMessage> out;
  TexturesGiven message;
  std::size_t uses = 0;
  const auto finish = [&] {
    if (!message.entries.empty()) out.push_back(encode_message(message));
    message.entries.clear();
    uses = 0;
  };
  for (const TextureEntry& entry : order_.textures().given().subspan(known)) {
    if (message.entries.size() == kTexturesGivenMax ||
        uses + entry.uses.size() > kTexturesGivenUsesMax)
      finish();
    uses += entry.uses.size();
    message.entries.push_back(entry);
  }
  finish();
  return out;
}

}  // namespace runstone
