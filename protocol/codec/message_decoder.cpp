#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <cmath>

#include "common/edits/edit_geometry.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/codec/utf8.hpp"
#include "protocol/schema/runstone_generated.h"

namespace runstone {
namespace {

Unexpected<Error> bad(const char* what) { return fail(ErrorCode::bad_value, what); }

/// Copies a byte vector of exactly N bytes; false if it is missing or of another size.
template <std::size_t N>
bool copy_exact(const flatbuffers::Vector<std::uint8_t>* from, std::array<std::uint8_t, N>& to) {
  if (from == nullptr || from->size() != N) return false;
  std::copy(from->begin(), from->end(), to.begin());
  return true;
}

ByteView view_of(const flatbuffers::Vector<std::uint8_t>* from) {
  return from == nullptr ? ByteView{} : ByteView(from->data(), from->size());
}

bool copy_text(const flatbuffers::String* from, std::size_t min, std::size_t max, std::string& to) {
  if (from == nullptr) return min == 0;
  if (from->size() < min || from->size() > max) return false;
  to.assign(from->c_str(), from->size());
  return is_utf8(to);
}

bool copy_key(const wire::Key* from, ChunkKey& to) {
  if (from == nullptr) return false;
  to = {from->lod(), {from->x(), from->y(), from->z()}};
  const auto inside = [](std::int32_t c) { return c >= -kWorldLimit && c < kWorldLimit; };
  return inside(to.at.x) && inside(to.at.y) && inside(to.at.z);
}

bool copy_position(const wire::Position* from, WorldPos& to) {
  if (from == nullptr) return false;
  to = {from->x(), from->y(), from->z()};
  const auto inside = [](double c) { return std::isfinite(c) && std::abs(c) <= kWorldLimit; };
  return inside(to.x) && inside(to.y) && inside(to.z);
}

bool copy_pose(const wire::Pose* from, Pose& to) {
  if (from == nullptr || !copy_position(&from->at(), to.at)) return false;
  to.yaw = from->yaw();
  to.pitch = from->pitch();
  return true;
}

bool copy_digest(const wire::Digest* from, Digest& to) {
  if (from == nullptr) return false;
  to.lane = {from->lane0(), from->lane1()};
  constexpr std::uint64_t kPrime = (1ULL << 61) - 1;
  return to.lane[0] < kPrime && to.lane[1] < kPrime;
}

/// Size of a table vector that may be absent, or nothing if it exceeds `max`.
template <class Vector>
std::optional<std::size_t> count_of(const Vector* vector, std::size_t max) {
  const std::size_t count = vector == nullptr ? 0 : vector->size();
  return count <= max ? std::optional(count) : std::nullopt;
}

/// Reads each kind of body. All checks that the verifier cannot make are here.
struct BodyReader {
  std::uint16_t chunk_edge;

  Result<Message> read(const wire::Hello& t) const {
    Hello m;
    m.protocol = t.protocol();
    m.instance = t.instance();
    m.encodings = t.encodings();
    if (m.protocol != kProtocolVersion) return m;  // the rest may look different in that version
    if (!copy_exact(t.key(), m.key)) return bad("hello.key is not 32 bytes");
    if (!copy_exact(t.nonce(), m.nonce)) return bad("hello.nonce is not 32 bytes");
    if (!copy_text(t.name(), 1, kPlayerNameBytesMax, m.name))
      return bad("hello.name is not 1..32 bytes of UTF-8");
    if (m.encodings == 0 || m.encodings > 3) return bad("hello.encodings names no known encoding");
    return m;
  }
  Result<Message> read(const wire::Welcome& t) const {
    Welcome m;
    m.protocol = t.protocol();
    if (m.protocol != kProtocolVersion) return m;
    m.epoch = t.epoch();
    m.durable = t.durable();
    m.head = t.head();
    m.chunk_edge = t.chunk_edge();
    m.y_min = t.y_min();
    m.y_max = t.y_max();
    m.encoding = static_cast<ChunkEncoding>(t.encoding());
    m.edit_volume_max = t.edit_volume_max();
    m.view_radius_max = t.view_radius_max();
    if (!copy_exact(t.world_id(), m.world_id)) return bad("welcome.world_id is not 16 bytes");
    if (!copy_exact(t.server_key(), m.server_key)) return bad("welcome.server_key is not 32 bytes");
    if (!copy_exact(t.challenge(), m.challenge)) return bad("welcome.challenge is not 32 bytes");
    if (!copy_exact(t.signature(), m.signature)) return bad("welcome.signature is not 64 bytes");
    if (!copy_position(t.spawn(), m.spawn)) return bad("welcome.spawn is outside the world");
    if (m.durable > m.head) return bad("welcome.durable is ahead of welcome.head");
    const bool edge_known =
        m.chunk_edge == 16 || m.chunk_edge == 32 || m.chunk_edge == 64 || m.chunk_edge == 128;
    if (!edge_known) return bad("welcome.chunk_edge is not 16, 32, 64 or 128");
    if (t.encoding() < 1 || t.encoding() > 2) return bad("welcome.encoding is unknown");
    if (m.view_radius_max > kViewRadiusMax) return bad("welcome.view_radius_max exceeds 64");
    if (auto ok = read_materials(t.materials(), m.materials); !ok) return Unexpected<Error>{ok.error()};
    return m;
  }
  static Result<void> read_materials(const flatbuffers::Vector<flatbuffers::Offset<wire::MaterialRow>>* rows,
                                     MaterialTable& table) {
    if (rows == nullptr || rows->size() == 0) return bad("welcome.materials is empty");
    if (rows->size() > kMaterialCountMax) return bad("welcome.materials has too many rows");
    for (std::uint32_t i = 1; i < rows->size(); ++i) {  // row 0 is air, as in every table
      const wire::MaterialRow& row = *rows->Get(i);
      MaterialInfo info;
      if (!copy_text(row.name(), 1, kMaterialNameBytesMax, info.name))
        return bad("material name is not 1..64 bytes of UTF-8");
      for (unsigned c = 0; c < 4; ++c) info.colour[c] = static_cast<std::uint8_t>(row.rgba() >> (8 * c));
      if (row.visibility() > static_cast<std::uint8_t>(Visibility::transparent))
        return bad("material visibility is unknown");
      info.visibility = static_cast<Visibility>(row.visibility());
      if (auto id = table.add(std::move(info)); !id) return Unexpected<Error>{id.error()};
    }
    return {};
  }
  Result<Message> read(const wire::Proof& t) const {
    Proof m;
    if (!copy_exact(t.signature(), m.signature)) return bad("proof.signature is not 64 bytes");
    return m;
  }
  Result<Message> read(const wire::Ready& t) const { return Ready{t.author(), t.decided()}; }
  Result<Message> read(const wire::View& t) const {
    View m{{t.x(), t.y(), t.z()}, t.radius_h(), t.radius_v()};
    const auto inside = [](std::int32_t c) { return c >= -kWorldLimit && c < kWorldLimit; };
    if (!inside(m.centre.x) || !inside(m.centre.y) || !inside(m.centre.z))
      return bad("view centre is outside the world");
    if (m.radius_h > kViewRadiusMax || m.radius_v > kViewRadiusMax)
      return bad("view radius exceeds 64 chunks");
    return m;
  }
  Result<Message> read(const wire::ChunkRequest& t) const {
    const auto count = count_of(t.keys(), kChunkRequestKeysMax);
    if (!count) return bad("chunk request names too many chunks");
    ChunkRequest m;
    for (std::size_t i = 0; i < *count; ++i) {
      if (!copy_key(t.keys()->Get(static_cast<std::uint32_t>(i)), m.keys.emplace_back()))
        return bad("chunk key is outside the world");
    }
    return m;
  }
  Result<Message> read(const wire::Chunk& t) const {
    ChunkSnapshot m;
    if (!copy_key(t.key(), m.key)) return bad("chunk key is missing or outside the world");
    if (t.version() == nullptr) return bad("chunk version is missing");
    m.chunk.version = {t.version()->epoch(), t.version()->seq()};
    if (!copy_digest(t.digest(), m.chunk.digest)) return bad("chunk digest is missing or not reduced");
    auto voxels = decode_chunk(view_of(t.data()));
    if (!voxels) return Unexpected<Error>{voxels.error()};
    m.chunk.voxels = std::move(*voxels);
    if (chunk_edge != 0 && m.chunk.voxels.extent != Extent::cube(chunk_edge))
      return bad("chunk is not of the world's size");
    return m;
  }
  Result<Message> read(const wire::EditRequest& t) const {
    EditRequest m;
    m.client_seq = t.client_seq();
    m.submitted_us = t.submitted_us();
    if (m.client_seq == 0) return bad("client sequences start at 1");
    auto edit = decode_descriptor(view_of(t.edit()));
    if (!edit) return Unexpected<Error>{edit.error()};
    m.edit = *edit;
    return m;
  }
  Result<Message> read(const wire::Commit& t) const {
    Commit m;
    m.epoch = t.epoch();
    m.first = t.first();
    const auto count = count_of(t.edits(), kCommitEditsMax);
    if (!count || *count == 0) return bad("commit has no edits or too many");
    if (m.first == 0 || m.first > UINT64_MAX - kCommitEditsMax) return bad("commit sequence is out of range");
    m.edits.reserve(*count);
    for (std::size_t i = 0; i < *count; ++i) {
      const wire::OrderedEdit& e = *t.edits()->Get(static_cast<std::uint32_t>(i));
      OrderedEdit& out = m.edits.emplace_back();
      out.op = {e.author(), e.instance(), e.client_seq()};
      if (e.cause() > kCauseMax) return bad("commit cause is unknown");
      out.cause = static_cast<Cause>(e.cause());
      out.submitted_us = e.submitted_us();
      out.ordered_us = e.ordered_us();
      auto edit = decode_descriptor(view_of(e.edit()));
      if (!edit) return Unexpected<Error>{edit.error()};
      out.edit = *edit;
      if (auto ok = read_previous(view_of(e.previous()), m.first + i, out); !ok)
        return Unexpected<Error>{ok.error()};
    }
    return m;
  }
  Result<void> read_previous(ByteView bytes, Sequence seq, OrderedEdit& out) const {
    if (bytes.size() > kTouchedChunksMax * 10) return bad("commit lists too many touched chunks");
    ByteReader in(bytes);
    while (in.ok() && !in.at_end()) {
      const std::uint64_t back = in.varint_max(seq, "previous sequence lies before the log");
      if (in.ok() && back == 0) return bad("an edit cannot precede itself");
      out.previous.push_back(seq - back);
    }
    if (!in.ok()) return Unexpected<Error>{in.error()};
    if (out.previous.size() > kTouchedChunksMax) return bad("commit lists too many touched chunks");
    if (chunk_edge == 0) return {};
    // Counted before it is listed: a hostile box could touch millions.
    if (touched_chunks_bound(out.edit, chunk_edge) > 2 * kTouchedChunksMax)
      return bad("edit touches too many chunks");
    if (touched_chunks(out.edit, chunk_edge).size() != out.previous.size()) {
      return bad("commit does not list one previous sequence per touched chunk");
    }
    return {};
  }
  Result<Message> read(const wire::Reject& t) const {
    Reject m;
    m.client_seq = t.client_seq();
    if (t.reason() == 0 || t.reason() > kRejectReasonMax) return bad("reject reason is unknown");
    m.reason = static_cast<RejectReason>(t.reason());
    if (!copy_text(t.detail(), 0, kTextBytesMax, m.detail))
      return bad("reject detail is too long or not UTF-8");
    return m;
  }
  Result<Message> read(const wire::Durable& t) const { return Durable{t.epoch(), t.seq()}; }
  Result<Message> read(const wire::Audit& t) const {
    const auto count = count_of(t.entries(), kAuditEntriesMax);
    if (!count) return bad("audit has too many entries");
    Audit m;
    for (std::size_t i = 0; i < *count; ++i) {
      const wire::AuditEntry& e = *t.entries()->Get(static_cast<std::uint32_t>(i));
      AuditEntry& out = m.entries.emplace_back();
      if (!copy_key(e.key(), out.key) || e.version() == nullptr || !copy_digest(e.digest(), out.digest)) {
        return bad("audit entry is incomplete");
      }
      out.version = {e.version()->epoch(), e.version()->seq()};
    }
    return m;
  }
  Result<Message> read(const wire::Move& t) const {
    Move m;
    if (!copy_pose(t.pose(), m.pose)) return bad("pose is missing or outside the world");
    return m;
  }
  Result<Message> read(const wire::PlayerPoses& t) const {
    const auto count = count_of(t.players(), kPlayersMax);
    if (!count) return bad("too many poses");
    PlayerPoses m;
    for (std::size_t i = 0; i < *count; ++i) {
      const wire::PlayerPose& p = *t.players()->Get(static_cast<std::uint32_t>(i));
      PlayerPose& out = m.players.emplace_back();
      out.author = p.author();
      if (!copy_pose(p.pose(), out.pose)) return bad("pose is missing or outside the world");
    }
    return m;
  }
  Result<Message> read(const wire::Roster& t) const {
    const auto count = count_of(t.players(), kPlayersMax);
    if (!count) return bad("too many players");
    Roster m;
    for (std::size_t i = 0; i < *count; ++i) {
      const wire::PlayerName& p = *t.players()->Get(static_cast<std::uint32_t>(i));
      PlayerName& out = m.players.emplace_back();
      out.author = p.author();
      if (!copy_text(p.name(), 1, kPlayerNameBytesMax, out.name))
        return bad("player name is not 1..32 bytes of UTF-8");
    }
    return m;
  }
  Result<Message> read(const wire::Ping& t) const { return Ping{t.sent_us()}; }
  Result<Message> read(const wire::Pong& t) const { return Pong{t.sent_us(), t.server_us()}; }
  Result<Message> read(const wire::Goodbye& t) const {
    Goodbye m;
    if (t.reason() == 0 || t.reason() > kGoodbyeReasonMax) return bad("goodbye reason is unknown");
    m.reason = static_cast<GoodbyeReason>(t.reason());
    if (!copy_text(t.text(), 0, kTextBytesMax, m.text)) return bad("goodbye text is too long or not UTF-8");
    return m;
  }
};

/// What each side may say, and in which class.
bool allowed(Sender sender, wire::Body body) {
  switch (body) {
    case wire::Body::Hello:
    case wire::Body::Proof:
    case wire::Body::View:
    case wire::Body::ChunkRequest:
    case wire::Body::EditRequest:
    case wire::Body::Move:
    case wire::Body::Ping:
      return sender == Sender::client;
    case wire::Body::Goodbye:
      return true;
    default:
      return sender == Sender::server;
  }
}

Result<Message> read_body(const wire::Message& message, const BodyReader& reader) {
  switch (message.body_type()) {
    case wire::Body::Hello:
      return reader.read(*message.body_as_Hello());
    case wire::Body::Welcome:
      return reader.read(*message.body_as_Welcome());
    case wire::Body::Proof:
      return reader.read(*message.body_as_Proof());
    case wire::Body::Ready:
      return reader.read(*message.body_as_Ready());
    case wire::Body::View:
      return reader.read(*message.body_as_View());
    case wire::Body::ChunkRequest:
      return reader.read(*message.body_as_ChunkRequest());
    case wire::Body::Chunk:
      return reader.read(*message.body_as_Chunk());
    case wire::Body::EditRequest:
      return reader.read(*message.body_as_EditRequest());
    case wire::Body::Commit:
      return reader.read(*message.body_as_Commit());
    case wire::Body::Reject:
      return reader.read(*message.body_as_Reject());
    case wire::Body::Durable:
      return reader.read(*message.body_as_Durable());
    case wire::Body::Audit:
      return reader.read(*message.body_as_Audit());
    case wire::Body::Move:
      return reader.read(*message.body_as_Move());
    case wire::Body::PlayerPoses:
      return reader.read(*message.body_as_PlayerPoses());
    case wire::Body::Roster:
      return reader.read(*message.body_as_Roster());
    case wire::Body::Ping:
      return reader.read(*message.body_as_Ping());
    case wire::Body::Pong:
      return reader.read(*message.body_as_Pong());
    case wire::Body::Goodbye:
      return reader.read(*message.body_as_Goodbye());
    case wire::Body::NONE:
      break;
  }
  return fail(ErrorCode::unknown_kind, "unknown message");  // an unknown union member passes the verifier
}

}  // namespace

Result<Message> decode_message(Sender sender, FrameClass frame_class, ByteView bytes,
                               std::uint16_t chunk_edge) {
  // The verifier checks offsets against the buffer, not the buffer's address; frames come 16-aligned.
  RUNSTONE_ASSERT(reinterpret_cast<std::uintptr_t>(bytes.data()) % 8 == 0);
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), kVerifierDepthMax, kVerifierTablesMax);
  if (!wire::VerifyMessageBuffer(verifier))
    return fail(ErrorCode::broken_invariant, "message does not verify");
  const wire::Message& message = *wire::GetMessage(bytes.data());
  if (message.body() == nullptr) return fail(ErrorCode::unknown_kind, "message has no body");
  if (message.body_type() <= wire::Body::NONE || message.body_type() > wire::Body::MAX) {
    return fail(ErrorCode::unknown_kind, "unknown message");
  }
  if (!allowed(sender, message.body_type()))
    return fail(ErrorCode::unknown_kind, "message not allowed from this side");
  auto decoded = read_body(message, BodyReader{chunk_edge});
  if (decoded && frame_class_of(*decoded) != frame_class)
    return fail(ErrorCode::bad_value, "message came in the wrong class");
  return decoded;
}

}  // namespace runstone
