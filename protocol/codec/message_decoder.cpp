#include <algorithm>
#include <limits>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/codec/commit_walk.hpp"
#include "protocol/codec/held_lists.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/codec/uniform_list.hpp"
#include "protocol/codec/wire_fields.hpp"

namespace runstone {
namespace {

bool is_time(TimeUs t) { return t >= -kWireTimeUsMax && t <= kWireTimeUsMax; }

Unexpected<Error> bad(const char* what) { return fail(ErrorCode::bad_value, what); }

using MaterialRows = flatbuffers::Vector<flatbuffers::Offset<wire::MaterialRow>>;

bool take_row(const wire::MaterialRow& row, MaterialInfo& info) {
  if (!take_text(row.name(), 1, kMaterialNameBytesMax, info.name)) return false;
  for (unsigned c = 0; c < 4; ++c)
    info.colour[c] = static_cast<std::uint8_t>(row.rgba() >> (8 * c));
  if (row.visibility() > static_cast<std::uint8_t>(Visibility::transparent)) return false;
  info.visibility = static_cast<Visibility>(row.visibility());
  return true;
}

Result<void> take_materials(const MaterialRows* rows, MaterialTable& table) {
  const auto count = count_of(rows, kMaterialCountMax);
  if (!count || *count == 0) return bad("welcome.materials has not 1 .. 65536 rows");
  for (std::uint32_t i = 0; i < *count; ++i) {
    MaterialInfo info;
    if (!take_row(*rows->Get(i), info)) return bad("bad row in welcome.materials");
    if (i == 0) {
      if (info != table[kEmpty]) return bad("row 0 of welcome.materials is not air");
    } else if (const auto id = table.add(std::move(info)); !id) {
      return Unexpected<Error>{id.error()};
    }
  }
  return {};
}

/// Reads each kind of body: the checks that the verifier cannot make.
struct BodyReader {
  std::int32_t chunk_edge;    // 0 before welcome
  std::size_t message_bytes;  // bounds what tables that share their bytes may add up to

  /// Before welcome, what suits every world.
  std::int32_t key_edge() const {
    return chunk_edge != 0 ? chunk_edge : static_cast<std::int32_t>(kSideMax);
  }

  /// 1 .. count_max keys, each inside the world.
  bool take_keys(const flatbuffers::Vector<const wire::Key*>* from, std::size_t count_max,
                 std::vector<ChunkKey>& to) const {
    const auto count = count_of(from, count_max);
    if (!count || *count == 0) return false;
    to.resize(*count);
    for (std::uint32_t i = 0; i < *count; ++i) {
      if (!take_key(from->Get(i), key_edge(), to[i])) return false;
    }
    return true;
  }

  Result<Message> read(const wire::Hello& t) const {
    Hello m;
    m.protocol = t.protocol();
    if (m.protocol != kProtocolVersion) return m;
    m.instance = t.instance();
    m.encodings = t.encodings();
    m.features = t.features();
    if (!take_exact(t.key(), m.key)) return bad("hello.key is not 32 bytes");
    if (!take_exact(t.nonce(), m.nonce)) return bad("hello.nonce is not 32 bytes");
    if (!take_text(t.name(), 1, kPlayerNameBytesMax, m.name))
      return bad("hello.name is not 1 .. 32 bytes of text");
    // Unknown bits are encodings of the future, and no harm.
    if ((m.encodings & kEncodingsKnown) == 0)
      return bad("hello.encodings names none that is known");
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
    m.heights = {t.y_min(), t.y_max()};
    m.encoding = static_cast<ChunkEncoding>(t.encoding());
    m.edit_volume_max = t.edit_volume_max();
    m.view_radius_max = t.view_radius_max();
    m.features = t.features();
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
    if (m.view_radius_max > kViewRadiusMax) return bad("welcome.view_radius_max exceeds 64");
    if (const auto ok = take_materials(t.materials(), m.materials); !ok)
      return Unexpected<Error>{ok.error()};
    return m;
  }

  Result<Message> read(const wire::ClientAuth& t) const {
    ClientAuth m;
    if (!take_exact(t.signature(), m.signature)) return bad("proof.signature is not 64 bytes");
    return m;
  }

  Result<Message> read(const wire::SessionAccepted& t) const {
    return SessionAccepted{t.author(), t.resolved()};
  }

  Result<Message> read(const wire::View& t) const {
    View m{{}, t.radius_h(), t.radius_v(), t.yaw(), t.pitch(), t.cone()};
    if (m.cone > kViewConeMax) return bad("view cone exceeds half a turn");
    if (!take_coord(t.x(), t.y(), t.z(), key_edge(), m.centre))
      return bad("view centre is outside the world");
    if (m.radius_h > kViewRadiusMax || m.radius_v > kViewRadiusMax)
      return bad("view radius exceeds 64 chunks");
    return m;
  }

  Result<Message> read(const wire::ChunkRequest& t) const {
    ChunkRequest m;
    if (!take_keys(t.keys(), kChunkRequestKeysMax, m.keys)) {
      return bad("chunk request has not 1 .. 64 keys inside the world");
    }
    return m;
  }

  Result<Message> read(const wire::Chunk& t) const {
    ChunkSnapshot m;
    if (!take_key(t.key(), key_edge(), m.key))
      return bad("chunk key is missing or outside the world");
    if (!take_version(t.version(), m.chunk.version))
      return bad("chunk version is missing or half zero");
    if (!take_digest(t.digest(), m.chunk.digest))
      return bad("chunk digest is missing or not reduced");
    const ByteView data = view_of(t.data());
    auto voxels = chunk_edge == 0
                      ? decode_chunk(data)
                      : decode_chunk(data, Extent::cube(static_cast<unsigned>(chunk_edge)));
    if (!voxels) return Unexpected<Error>{voxels.error()};
    m.chunk.voxels = *std::move(voxels);
    return Message{std::move(m)};
  }

  Result<Message> read(const wire::ChunkUnavailable& t) const {
    ChunkUnavailable m;
    if (!take_keys(t.keys(), kUnavailableKeysMax, m.keys)) {
      return bad("unavailable chunks are not 1 .. 64 keys inside the world");
    }
    if (t.reason() == 0) return bad("unavailable reason is 0");
    m.reason = static_cast<UnavailableReason>(t.reason());  // later reasons are no harm
    return m;
  }

  Result<Message> read(const wire::CachedChunks& t) const {
    auto chunks = decode_held(view_of(t.chunks()), key_edge());
    if (!chunks) return Unexpected<Error>{chunks.error()};
    return Message{CachedChunks{*std::move(chunks)}};
  }

  Result<Message> read(const wire::ChunksNotModified& t) const {
    auto chunks = decode_same(view_of(t.chunks()), key_edge());
    if (!chunks) return Unexpected<Error>{chunks.error()};
    return Message{ChunksNotModified{*std::move(chunks)}};
  }

  Result<Message> read(const wire::ChunkEdits& t) const {
    ChunkEdits m;
    if (!take_key(t.key(), key_edge(), m.key))
      return bad("chunk key is missing or outside the world");
    if (!take_version(t.to(), m.to)) return bad("chunk version is missing or half zero");
    if (!take_digest(t.digest(), m.digest)) return bad("chunk digest is missing or not reduced");
    m.from = t.from();
    if (m.from >= m.to.seq || m.to.seq > kSequenceMax)
      return bad("missing edits lead back, or too far");
    auto edits = decode_missing(view_of(t.edits()), m.from);
    if (!edits) return Unexpected<Error>{edits.error()};
    m.edits = *std::move(edits);
    if (m.edits.back().seq != m.to.seq)
      return bad("missing edits end elsewhere than the chunk's version");
    return Message{std::move(m)};
  }

  Result<Message> read(const wire::HistoryRequest& t) const {
    if (t.request() == 0) return bad("travel requests start at 1");
    if (t.to() > kHistoryTargetMax)
      return bad("travel goes neither to the live world, nor to a sequence, nor to a time");
    const auto to = static_cast<HistoryTarget>(t.to());
    if (t.seq() > kSequenceMax || (to != HistoryTarget::sequence && t.seq() != 0)) {
      return bad("travel sequence exceeds 63 bits, or is given without being asked for");
    }
    if (!is_time(t.utc_us()) || (to != HistoryTarget::time && t.utc_us() != 0)) {
      return bad("travel time is out of range, or is given without being asked for");
    }
    return HistoryRequest{t.request(), to, t.seq(), t.utc_us()};
  }

  Result<Message> read(const wire::HistoryState& t) const {
    HistoryState m;
    if (t.request() == 0) return bad("moment answers no request");
    if (t.phase() == 0 || t.phase() > kHistoryPhaseMax) return bad("moment phase is unknown");
    if (t.seq() > kSequenceMax || (!t.past() && t.seq() != 0))
      return bad("moment sequence is out of range");
    if (!is_time(t.utc_us())) return bad("moment time is out of range");
    m.request = t.request();
    m.phase = static_cast<HistoryPhase>(t.phase());
    m.past = t.past();
    m.seq = t.seq();
    m.utc_us = t.utc_us();
    if (!take_text(t.text(), 0, kTextBytesMax, m.text))
      return bad("moment text is not 0 .. 256 bytes of text");
    return m;
  }

  Result<Message> read(const wire::EditRequest& t) const {
    EditRequest m;
    m.client_seq = t.client_seq();
    m.submitted_us = t.submitted_us();
    if (!is_time(m.submitted_us)) return bad("edit request time is out of range");
    if (m.client_seq == 0) return bad("client sequences start at 1");
    if (m.client_seq > kSequenceMax) return bad("client sequence exceeds 63 bits");
    auto edit = decode_descriptor(view_of(t.edit()));
    if (!edit) return Unexpected<Error>{edit.error()};
    m.edit = *edit;
    return m;
  }

  Result<Message> read(const wire::Commit& t) const {
    Commit m;
    m.epoch = t.epoch();
    m.first = t.first();
    m.edits.reserve(
        t.edits() == nullptr ? 0 : std::min<std::size_t>(t.edits()->size(), kCommitEditsMax));
    OrderedEdit edit;
    std::vector<ChunkCoord> touched;
    const auto ok = read_edits(t, edit, touched, [&m, &edit](Sequence) -> Result<void> {
      m.edits.push_back(std::move(edit));
      return {};
    });
    if (!ok) return Unexpected<Error>{ok.error()};
    return Message{std::move(m)};
  }

  /// Reads each edit into `edit`, the chunks it touches into `touched` (none before welcome), and calls `take` with its
  /// sequence, which may move from both.
  template <class F>
  Result<void> read_edits(const wire::Commit& t, OrderedEdit& edit,
                          std::vector<ChunkCoord>& touched, F&& take) const {
    const auto count = count_of(t.edits(), kCommitEditsMax);
    if (!count || *count == 0) return bad("commit has not 1 .. 4096 edits");
    if (t.epoch() == 0) return bad("commit epoch is 0");
    const Sequence first = t.first();
    if (first == 0 || first > std::numeric_limits<Sequence>::max() - kCommitEditsMax) {
      return bad("commit sequence is out of range");
    }
    std::size_t previous_bytes = 0;
    for (std::uint32_t i = 0; i < *count; ++i) {
      const wire::OrderedEdit& e = *t.edits()->Get(i);
      edit.op = {e.author(), e.instance(), e.client_seq()};
      if (e.cause() > kCauseMax) return bad("commit cause is unknown");
      edit.cause = static_cast<Cause>(e.cause());
      edit.submitted_us = e.submitted_us();
      edit.ordered_us = e.ordered_us();
      if (!is_time(edit.submitted_us) || !is_time(edit.ordered_us))
        return bad("commit time is out of range");
      edit.subject = e.subject();
      if (edit.subject >= first + i) return bad("commit subject is not an earlier edit");
      auto descriptor = decode_descriptor(view_of(e.edit()));
      if (!descriptor) return Unexpected<Error>{descriptor.error()};
      edit.edit = *std::move(descriptor);
      const ByteView previous = view_of(e.previous());
      previous_bytes += previous.size();
      // Tables may point at one list again and again; what is decoded would outgrow the message.
      if (previous_bytes > message_bytes)
        return bad("commit shares its lists of previous sequences");
      if (const auto ok = read_previous(previous, first + i, edit, touched); !ok) return ok;
      if (const auto ok = take(first + i); !ok) return ok;
    }
    return {};
  }

  Result<void> read_previous(ByteView bytes, Sequence seq, OrderedEdit& out,
                             std::vector<ChunkCoord>& touched) const {
    out.previous.clear();
    ByteReader in(bytes);
    while (in.ok() && !in.at_end()) {
      const std::uint64_t back = in.varint_max(seq, "previous sequence lies before the log");
      if (back == 0) in.reject(ErrorCode::bad_value, "an edit cannot precede itself");
      if (out.previous.size() == kTouchedChunksMax)
        in.reject(ErrorCode::limit_exceeded, "edit touches too many chunks");
      if (in.ok()) out.previous.push_back(seq - back);
    }
    if (!in.ok()) return Unexpected<Error>{in.error()};
    if (chunk_edge == 0) return {};
    // Bounded before they are listed: a hostile box may touch millions. Servers count by the same bound.
    if (touched_chunks_bound(out.edit, chunk_edge) > kTouchedChunksMax) {
      return fail(ErrorCode::limit_exceeded, "edit touches too many chunks");
    }
    touched_chunks(out.edit, chunk_edge, touched);
    if (touched.size() != out.previous.size()) {
      return bad("commit does not list one previous sequence per touched chunk");
    }
    return {};
  }

  Result<Message> read(const wire::Reject& t) const {
    Reject m;
    m.client_seq = t.client_seq();
    if (m.client_seq == 0) return bad("client sequences start at 1");
    if (t.reason() == 0 || t.reason() > kRejectReasonMax) return bad("reject reason is unknown");
    m.reason = static_cast<RejectReason>(t.reason());
    m.seq = t.seq();
    if (m.seq != 0 && m.reason != RejectReason::already_resolved)
      return bad("reject names a sequence");
    if (!take_text(t.detail(), 0, kTextBytesMax, m.detail))
      return bad("reject detail is not 0 .. 256 bytes of text");
    return m;
  }

  Result<Message> read(const wire::Durable& t) const {
    if (t.epoch() == 0) return bad("durable epoch is 0");
    return Durable{t.epoch(), t.seq()};
  }

  Result<Message> read(const wire::DigestCheck& t) const {
    const auto count = count_of(t.entries(), kAuditEntriesMax);
    if (!count) return bad("audit has too many entries");
    DigestCheck m;
    m.entries.resize(*count);
    for (std::uint32_t i = 0; i < *count; ++i) {
      const wire::DigestCheckEntry& e = *t.entries()->Get(i);
      DigestCheckEntry& out = m.entries[i];
      if (!take_key(e.key(), key_edge(), out.key) || !take_version(e.version(), out.version) ||
          !take_digest(e.digest(), out.digest)) {
        return bad("audit entry has a bad key, version or digest");
      }
    }
    return m;
  }

  Result<Message> read(const wire::Move& t) const {
    Move m;
    if (!take_pose(t.pose(), m.pose)) return bad("pose is missing or outside the world");
    return m;
  }

  Result<Message> read(const wire::PlayerPoses& t) const {
    const auto count = count_of(t.players(), kPlayersMax);
    if (!count) return bad("too many poses");
    PlayerPoses m;
    m.players.resize(*count);
    for (std::uint32_t i = 0; i < *count; ++i) {
      const wire::PlayerPose& p = *t.players()->Get(i);
      m.players[i].author = p.author();
      if (!take_pose(p.pose(), m.players[i].pose))
        return bad("pose is missing or outside the world");
    }
    return m;
  }

  Result<Message> read(const wire::PlayerList& t) const {
    const auto count = count_of(t.players(), kPlayersMax);
    if (!count) return bad("too many players");
    PlayerList m;
    m.players.resize(*count);
    for (std::uint32_t i = 0; i < *count; ++i) {
      const wire::PlayerName& p = *t.players()->Get(i);
      m.players[i].author = p.author();
      if (!take_text(p.name(), 1, kPlayerNameBytesMax, m.players[i].name)) {
        return bad("player name is not 1 .. 32 bytes of text");
      }
    }
    m.is_change = t.change();
    const auto gone =
        t.left() == nullptr ? std::optional<std::uint32_t>(0) : count_of(t.left(), kPlayersMax);
    if (!gone || (*gone != 0 && !m.is_change))
      return bad("too many players left, or from a whole roster");
    if (*gone != 0) m.left.assign(t.left()->begin(), t.left()->end());
    return m;
  }

  Result<Message> read(const wire::Ping& t) const {
    if (!is_time(t.sent_us())) return bad("ping time is out of range");
    return Ping{t.sent_us()};
  }
  Result<Message> read(const wire::Pong& t) const {
    if (!is_time(t.sent_us()) || !is_time(t.server_us())) return bad("pong time is out of range");
    return Pong{t.sent_us(), t.server_us()};
  }

  Result<Message> read(const wire::Goodbye& t) const {
    Goodbye m;
    if (t.reason() == 0 || t.reason() > kGoodbyeReasonMax) return bad("goodbye reason is unknown");
    m.reason = static_cast<GoodbyeReason>(t.reason());
    if (!take_text(t.text(), 0, kTextBytesMax, m.text))
      return bad("goodbye text is not 0 .. 256 bytes of text");
    return m;
  }

  Result<Message> read(const wire::CommandRequest& t) const {
    CommandRequest m;
    m.id = t.id();
    if (!take_text(t.text(), 1, kCommandBytesMax, m.text))
      return bad("command is not 1 .. 1024 bytes of text");
    return m;
  }
  Result<Message> read(const wire::CommandOutput& t) const {
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
  Result<Message> read(const wire::ReceiveAck& t) const {
    if (t.chunk_bytes() == 0) return bad("received counts no bytes");
    return ReceiveAck{t.chunk_bytes()};
  }
  Result<Message> read(const wire::UniformChunks& t) const {
    auto chunks = decode_uniform(view_of(t.data()), key_edge());
    if (!chunks) return Unexpected<Error>{chunks.error()};
    return Message{UniformChunks{*std::move(chunks)}};
  }
};

/// Who may send a body, and in which class it travels.
struct Route {
  bool from_client = false, from_server = false;
  FrameClass frame_class = FrameClass::control;
};

/// Nothing for types that this build does not know: the generated verifier lets those pass.
std::optional<Route> route_of(wire::Body body) {
  switch (body) {
    case wire::Body::Hello:
    case wire::Body::ClientAuth:
    case wire::Body::View:
    case wire::Body::ChunkRequest:
    case wire::Body::Move:
    case wire::Body::Ping:
    case wire::Body::HistoryRequest:
    case wire::Body::CommandRequest:
    case wire::Body::ReceiveAck:
    case wire::Body::CachedChunks:
      return Route{true, false, FrameClass::control};
    case wire::Body::EditRequest:
      return Route{true, false, FrameClass::edits};
    case wire::Body::Welcome:
    case wire::Body::DigestCheck:
    case wire::Body::PlayerPoses:
    case wire::Body::PlayerList:
    case wire::Body::Pong:
    case wire::Body::CommandOutput:
      return Route{false, true, FrameClass::control};
    case wire::Body::SessionAccepted:
    case wire::Body::Commit:
    case wire::Body::Reject:
    case wire::Body::Durable:
      return Route{false, true, FrameClass::edits};
    case wire::Body::Chunk:
    case wire::Body::ChunkUnavailable:
    case wire::Body::HistoryState:
    case wire::Body::UniformChunks:
    case wire::Body::ChunksNotModified:
    case wire::Body::ChunkEdits:
      return Route{false, true, FrameClass::chunks};
    case wire::Body::Goodbye:
      return Route{true, true, FrameClass::control};
    case wire::Body::NONE:
      break;
  }
  return std::nullopt;
}

Result<Message> read_body(const wire::Message& message, const BodyReader& reader) {
  switch (message.body_type()) {
    case wire::Body::Hello:
      return reader.read(*message.body_as_Hello());
    case wire::Body::Welcome:
      return reader.read(*message.body_as_Welcome());
    case wire::Body::ClientAuth:
      return reader.read(*message.body_as_ClientAuth());
    case wire::Body::SessionAccepted:
      return reader.read(*message.body_as_SessionAccepted());
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
    case wire::Body::DigestCheck:
      return reader.read(*message.body_as_DigestCheck());
    case wire::Body::Move:
      return reader.read(*message.body_as_Move());
    case wire::Body::PlayerPoses:
      return reader.read(*message.body_as_PlayerPoses());
    case wire::Body::PlayerList:
      return reader.read(*message.body_as_PlayerList());
    case wire::Body::Ping:
      return reader.read(*message.body_as_Ping());
    case wire::Body::Pong:
      return reader.read(*message.body_as_Pong());
    case wire::Body::Goodbye:
      return reader.read(*message.body_as_Goodbye());
    case wire::Body::ChunkUnavailable:
      return reader.read(*message.body_as_ChunkUnavailable());
    case wire::Body::HistoryRequest:
      return reader.read(*message.body_as_HistoryRequest());
    case wire::Body::HistoryState:
      return reader.read(*message.body_as_HistoryState());
    case wire::Body::CommandRequest:
      return reader.read(*message.body_as_CommandRequest());
    case wire::Body::CommandOutput:
      return reader.read(*message.body_as_CommandOutput());
    case wire::Body::ReceiveAck:
      return reader.read(*message.body_as_ReceiveAck());
    case wire::Body::UniformChunks:
      return reader.read(*message.body_as_UniformChunks());
    case wire::Body::CachedChunks:
      return reader.read(*message.body_as_CachedChunks());
    case wire::Body::ChunksNotModified:
      return reader.read(*message.body_as_ChunksNotModified());
    case wire::Body::ChunkEdits:
      return reader.read(*message.body_as_ChunkEdits());
    case wire::Body::NONE:
      break;
  }
  return fail(ErrorCode::unknown_kind, "unknown message type");
}

/// The message in these bytes, verified, of a kind that this side may send in this class.
Result<const wire::Message*> open_message(Sender sender, FrameClass frame_class, ByteView bytes) {
  // The verifier checks alignment relative to the buffer's first byte only.
  RUNSTONE_ASSERT(reinterpret_cast<std::uintptr_t>(bytes.data()) % 8 == 0);
  if (bytes.size() > message_bytes_max(sender, frame_class)) {
    return fail(ErrorCode::limit_exceeded, "message exceeds the limit of its class");
  }
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), kVerifierDepthMax, kVerifierTablesMax);
  if (!wire::VerifyMessageBuffer(verifier))
    return fail(ErrorCode::broken_invariant, "message does not verify");
  const wire::Message& message = *wire::GetMessage(bytes.data());
  const auto route = route_of(message.body_type());
  if (!route) return fail(ErrorCode::unknown_kind, "unknown message type");
  if (message.body() == nullptr) return fail(ErrorCode::broken_invariant, "message has no body");
  if (!(sender == Sender::client ? route->from_client : route->from_server)) {
    return bad("message not allowed from this side");
  }
  if (route->frame_class != frame_class) return bad("message came in the wrong class");
  return &message;
}

}  // namespace

Result<Message> decode_message(Sender sender, FrameClass frame_class, ByteView bytes,
                               std::uint16_t chunk_edge) {
  const auto message = open_message(sender, frame_class, bytes);
  if (!message) return Unexpected<Error>{message.error()};
  return read_body(**message, BodyReader{chunk_edge, bytes.size()});
}

Result<bool> CommitWalk::read(ByteView bytes, std::uint16_t chunk_edge, const OnEdit& on_edit) {
  RUNSTONE_ASSERT(chunk_edge != 0);
  const auto message = open_message(Sender::server, FrameClass::edits, bytes);
  if (!message) return Unexpected<Error>{message.error()};
  const wire::Commit* commit = (*message)->body_as_Commit();
  if (commit == nullptr) return false;
  const Epoch epoch = commit->epoch();
  const auto ok = BodyReader{chunk_edge, bytes.size()}.read_edits(
      *commit, edit_, chunks_,
      [&](Sequence seq) { return on_edit({{epoch, seq}, edit_, chunks_}); });
  if (!ok) return Unexpected<Error>{ok.error()};
  return true;
}

}  // namespace runstone
