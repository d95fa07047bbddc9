#include <algorithm>
#include <utility>
#include <vector>

#include "protocol/codec/body_reader.hpp"
#include "protocol/codec/shape_list.hpp"

namespace runstone {
namespace {

Result<void> take_materials(const wire::Welcome& t, MaterialTable& table) {
  const auto* rows = t.materials();
  const auto count = count_of(rows, kMaterialCountMax);
  if (!count || *count == 0) return bad("welcome.materials has not 1 .. 65536 rows");
  const bool has_shapes = (t.features() & kFeatureShapes) != 0;
  if (!has_shapes && t.shapes() != nullptr) return bad("welcome.shapes without the feature shapes");
  const auto shapes = decode_shapes(view_of(t.shapes()));
  if (!shapes) return failure(shapes.error());
  std::vector<bool> used(shapes->size() + 1, false);
  used[0] = true;
  for (std::uint32_t i = 0; i < *count; ++i) {
    MaterialInfo info;
    if (!take_material(*rows->Get(i), info)) return bad("bad row in welcome.materials");
    const std::size_t shape = rows->Get(i)->shape();
    if (shape > shapes->size()) return bad("a row of welcome.materials has an unknown shape");
    used[shape] = true;
    if (shape != 0) info.shape = (*shapes)[shape - 1];
    if (i == 0) {
      info.look.reset();  // air is not drawn, and a look is never a reason to refuse a row
      if (info != table[kEmpty]) return bad("row 0 of welcome.materials is not air");
    } else if (const auto id = table.add(std::move(info)); !id) {
      return failure(id.error());
    }
  }
  if (std::find(used.begin(), used.end(), false) != used.end())
    return bad("a shape of welcome.shapes has no material");
  return {};
}

}  // namespace

Result<Message> BodyReader::read(const wire::Hello& t) const {
  Hello m;
  m.protocol = t.protocol();
  if (m.protocol != kProtocolVersion) return m;
  m.instance = t.instance();
  m.encodings = t.encodings();
  m.features = t.features();
  if (!take_exact(t.key(), m.key)) return bad("hello.key is not 32 bytes");
  if (!take_exact(t.nonce(), m.nonce)) return bad("hello.nonce is not 32 bytes");
  if (!take_text(t.name(), 1, kPlayerNameBytesMax, m.name) || !is_plain_name(m.name))
    return bad("hello.name is not a name of 1 .. 32 bytes");
  // Unknown bits are accepted: they stand for encodings of later versions.
  if ((m.encodings & kEncodingsKnown) == 0) return bad("hello.encodings names none that is known");
  return m;
}

Result<Message> BodyReader::read(const wire::Welcome& t) const {
  Welcome m;
  m.protocol = t.protocol();
  if (m.protocol != kProtocolVersion) return m;
  m.epoch = t.epoch();
  m.durable = t.durable();
  m.head = t.head();
  m.chunk_edge = t.chunk_edge();
  m.heights = {t.y_min(), t.y_max()};
  m.encoding = static_cast<ChunkEncoding>(t.encoding());
  m.edit_volume_max = t.edit_volume_max();
  m.edit_budget = {t.edits_per_second(), t.edit_burst()};
  m.view_radius_max = t.view_radius_max();
  m.features = t.features();
  m.tile_levels_max = t.tile_levels_max();
  m.waiting_edits_max = t.waiting_edits_max();
  m.waiting_edit_bytes_max = t.waiting_edit_bytes_max();
  if (!take_exact(t.world_id(), m.world_id)) return bad("welcome.world_id is not 16 bytes");
  if (!take_exact(t.server_key(), m.server_key)) return bad("welcome.server_key is not 32 bytes");
  if (!take_exact(t.challenge(), m.challenge)) return bad("welcome.challenge is not 32 bytes");
  if (!take_exact(t.signature(), m.signature)) return bad("welcome.signature is not 64 bytes");
  if (!take_position(t.spawn(), m.spawn)) return bad("welcome.spawn is outside the world");
  if (m.epoch == 0) return bad("welcome.epoch is 0");
  if (m.durable > m.head) return bad("welcome.durable is ahead of welcome.head");
  const bool edge_known =
      m.chunk_edge == 16 || m.chunk_edge == 32 || m.chunk_edge == 64 || m.chunk_edge == 128;
  if (!edge_known) return bad("welcome.chunk_edge is not 16, 32, 64 or 128");
  if (!validate(m.heights)) return bad("welcome.y_min .. y_max");
  if (!encoding_known(t.encoding())) return bad("welcome.encoding is unknown");
  if ((m.edit_budget.per_second == 0) != (m.edit_budget.burst == 0))
    return bad("welcome.edits_per_second and edit_burst are not both 0 or both above");
  if (m.view_radius_max > kViewRadiusMax) return bad("welcome.view_radius_max exceeds 64");
  if ((m.features & kFeatureLargeActions) != 0 &&
      (m.waiting_edits_max == 0 || m.waiting_edit_bytes_max < kDescriptorBytesMax))
    return bad("welcome.waiting_edits_max and waiting_edit_bytes_max have no room for an edit");
  if (m.tile_levels_max > kTileLevelMax) return bad("welcome.tile_levels_max exceeds 8");
  if (t.password_salt() != nullptr && !take_exact(t.password_salt(), m.password_salt.emplace()))
    return bad("welcome.password_salt is not 16 bytes");
  if (const auto ok = take_materials(t, m.materials); !ok) return failure(ok.error());
  return m;
}

Result<Message> BodyReader::read(const wire::ClientAuth& t) const {
  ClientAuth m;
  if (!take_exact(t.signature(), m.signature)) return bad("client_auth.signature is not 64 bytes");
  if (t.ticket() != nullptr && !take_text(t.ticket(), 1, kTicketBytesMax, m.ticket))
    return bad("client_auth.ticket is not 1 .. 128 bytes of text");
  if (t.password_key() != nullptr && !take_exact(t.password_key(), m.password_key.emplace()))
    return bad("client_auth.password_key is not 32 bytes");
  return m;
}

Result<Message> BodyReader::read(const wire::SessionAccepted& t) const {
  SessionAccepted m{t.author(), t.resolved(), t.tile_rules()};
  if (t.place() != nullptr && !take_pose(t.place(), m.place.emplace()))
    return bad("session_accepted: place is outside the world");
  return m;
}

Result<Message> BodyReader::read(const wire::WorldTime& t) const {
  const WorldTime m{t.day_ms(), t.rate()};
  if (!is_valid(m)) return bad("world_time: time or rate is out of range");
  return m;
}

Result<Message> BodyReader::read(const wire::Ping& t) const {
  if (!is_time(t.sent_us())) return bad("ping time is out of range");
  return Ping{t.sent_us()};
}

Result<Message> BodyReader::read(const wire::Pong& t) const {
  if (!is_time(t.sent_us()) || !is_time(t.server_us())) return bad("pong time is out of range");
  return Pong{t.sent_us(), t.server_us()};
}

Result<Message> BodyReader::read(const wire::Goodbye& t) const {
  Goodbye m;
  if (t.reason() == 0 || t.reason() > kGoodbyeReasonMax) return bad("goodbye reason is unknown");
  m.reason = static_cast<GoodbyeReason>(t.reason());
  if (!take_text(t.text(), 0, kTextBytesMax, m.text))
    return bad("goodbye text is not 0 .. 256 bytes of text");
  return m;
}

Result<Message> BodyReader::read(const wire::Move& t) const {
  Move m;
  if (!take_pose(t.pose(), m.pose)) return bad("pose is missing or outside the world");
  return m;
}

Result<Message> BodyReader::read(const wire::PlayerPoses& t) const {
  const auto count = count_of(t.players(), kPlayersMax);
  if (!count) return bad("too many poses");
  PlayerPoses m;
  m.players.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    const wire::PlayerPose& p = *t.players()->Get(i);
    m.players[i].author = p.author();
    if (!take_pose(p.pose(), m.players[i].pose)) return bad("pose is missing or outside the world");
  }
  return m;
}

Result<Message> BodyReader::read(const wire::PlayerList& t) const {
  const auto count = count_of(t.players(), kPlayersMax);
  if (!count) return bad("too many players");
  PlayerList m;
  m.players.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    const wire::PlayerName& p = *t.players()->Get(i);
    m.players[i].author = p.author();
    if (!take_text(p.name(), 1, kPlayerNameBytesMax, m.players[i].name) ||
        !is_plain_name(m.players[i].name)) {
      return bad("player name is not a name of 1 .. 32 bytes");
    }
    if (!take_exact(p.key(), m.players[i].key)) return bad("player key is not 32 bytes");
    if (!take_text(p.role(), 0, kGroundNameBytesMax, m.players[i].role))
      return bad("role of a player is not 0 .. 32 bytes of text");
  }
  m.is_change = t.change();
  const auto gone =
      t.left() == nullptr ? std::optional<std::uint32_t>(0) : count_of(t.left(), kPlayersMax);
  if (!gone || (*gone != 0 && !m.is_change))
    return bad("a complete player list names players that left, or a change too many");
  if (*gone != 0) m.left.assign(t.left()->begin(), t.left()->end());
  return m;
}

Result<Message> BodyReader::read(const wire::CommandRequest& t) const {
  CommandRequest m;
  m.id = t.id();
  if (!take_text(t.text(), 1, kCommandBytesMax, m.text))
    return bad("command is not 1 .. 1024 bytes of text");
  return m;
}

Result<Message> BodyReader::read(const wire::CommandOutput& t) const {
  CommandOutput m;
  m.id = t.id();
  m.is_done = t.done();
  m.is_ok = t.ok();
  const auto count = count_of(t.lines(), kCommandLinesMax);
  if (!count) return bad("command output has more than 64 lines");
  m.lines.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    if (!take_text(t.lines()->Get(i), 0, kCommandLineBytesMax, m.lines[i])) {
      return bad("line of command output is not 0 .. 1024 bytes of text");
    }
  }
  return m;
}

Result<Message> BodyReader::read(const wire::ReceiveAck& t) const {
  if (t.chunk_bytes() == 0) return bad("receive ack counts no bytes");
  return ReceiveAck{t.chunk_bytes()};
}

}  // namespace runstone
