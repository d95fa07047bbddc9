#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <utility>

#include "common/core/text.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/chunk_lists.hpp"
#include "protocol/codec/commit_encoder.hpp"
#include "protocol/codec/key_list.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/codec/patch_list.hpp"
#include "protocol/codec/preview_list.hpp"
#include "protocol/codec/shape_list.hpp"
#include "protocol/codec/texture_list.hpp"
#include "protocol/codec/uniform_list.hpp"
#include "protocol/schema/runstone_generated.h"

namespace runstone {
namespace {

constexpr std::size_t kBuilderBytes = 1024;
constexpr std::size_t kBuilderBytesKept = 256 * 1024;

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

template <std::size_t N>
auto bytes_of(FlatBufferBuilder& b, const std::array<std::uint8_t, N>& v) {
  return b.CreateVector(v.data(), v.size());
}
auto bytes_of(FlatBufferBuilder& b, const Bytes& v) { return b.CreateVector(v.data(), v.size()); }

wire::Position position_of(const WorldPos& p) { return {p.x, p.y, p.z}; }
wire::Pose pose_of(const Pose& p) { return {position_of(p.at), p.yaw, p.pitch}; }

/// Builds the table of each message.
struct BodyBuilder {
  FlatBufferBuilder& b;

  Offset<wire::Hello> operator()(const Hello& m) {
    RUNSTONE_ASSERT(!m.name.empty() && m.name.size() <= kPlayerNameBytesMax && m.encodings != 0);
    const auto key = bytes_of(b, m.key);
    const auto nonce = bytes_of(b, m.nonce);
    const auto name = b.CreateString(m.name);
    return wire::CreateHello(b, m.protocol, key, m.instance, nonce, name, m.encodings, m.features);
  }
  Offset<wire::Welcome> operator()(const Welcome& m) {
    const bool has_shapes = (m.features & kFeatureShapes) != 0;
    const ShapeList shapes = has_shapes ? ShapeList(m.materials) : ShapeList();
    const auto materials = material_rows(m.materials.rows(), shapes);
    const auto shape_bytes = shapes.empty() ? 0 : bytes_of(b, shapes.encode());
    const auto world_id = bytes_of(b, m.world_id);
    const auto server_key = bytes_of(b, m.server_key);
    const auto challenge = bytes_of(b, m.challenge);
    const auto signature = bytes_of(b, m.signature);
    const auto salt = optional_bytes(m.password_salt);
    const wire::Position spawn = position_of(m.spawn);
    return wire::CreateWelcome(b, m.protocol, world_id, m.epoch, m.durable, m.head, m.chunk_edge,
                               m.heights.y_min, m.heights.y_max, &spawn, materials, server_key,
                               challenge, signature, static_cast<std::uint8_t>(m.encoding),
                               m.edit_volume_max, m.edit_budget.per_second, m.edit_budget.burst,
                               m.view_radius_max, m.features, salt, m.tile_levels_max,
                               m.waiting_edits_max, m.waiting_edit_bytes_max, shape_bytes);
  }
  Offset<wire::ClientAuth> operator()(const ClientAuth& m) {
    const auto signature = bytes_of(b, m.signature);
    const auto ticket = optional_text(m.ticket);
    return wire::CreateClientAuth(b, signature, ticket, optional_bytes(m.password_key));
  }
  Offset<wire::SessionAccepted> operator()(const SessionAccepted& m) {
    const wire::Pose place = pose_of(m.place.value_or(Pose{}));
    return wire::CreateSessionAccepted(b, m.author, m.resolved, m.tile_rules,
                                       m.place ? &place : nullptr);
  }
  Offset<wire::View> operator()(const View& m) {
    RUNSTONE_ASSERT(m.number != 0);
    return wire::CreateView(b, m.number, m.centre.x, m.centre.y, m.centre.z, m.radius_h, m.radius_v,
                            m.yaw, m.pitch, m.cone, m.levels);
  }
  Offset<wire::ChunkRequest> operator()(const ChunkRequest& m) {
    RUNSTONE_ASSERT(!m.keys.empty() && m.keys.size() <= kChunkRequestKeysMax);
    return wire::CreateChunkRequest(b, bytes_of(b, encode_keys(m.keys)));
  }
  Offset<wire::Chunks> operator()(const Chunks& m) {
    std::vector<ChunkEntry> entries;
    entries.reserve(m.chunks.size());
    for (const ChunkAnswer& answer : m.chunks) entries.push_back(encode_answer(answer));
    return chunks(m.view, entries);
  }
  Offset<wire::ChunkUnavailable> operator()(const ChunkUnavailable& m) {
    RUNSTONE_ASSERT(!m.keys.empty() && m.keys.size() <= kUnavailableKeysMax);
    return wire::CreateChunkUnavailable(b, m.view, bytes_of(b, encode_keys(m.keys)),
                                        static_cast<std::uint8_t>(m.reason));
  }
  Offset<wire::CachedChunks> operator()(const CachedChunks& m) {
    return wire::CreateCachedChunks(b, bytes_of(b, encode_cached_chunks(m.chunks)),
                                    m.chunks.front().key.lod);
  }
  Offset<wire::ChunksNotModified> operator()(const ChunksNotModified& m) {
    return wire::CreateChunksNotModified(b, m.view, bytes_of(b, encode_unmodified(m.chunks)),
                                         m.chunks.front().key.lod);
  }
  Offset<wire::HistoryRequest> operator()(const HistoryRequest& m) {
    return wire::CreateHistoryRequest(b, m.request, static_cast<std::uint8_t>(m.to), m.seq,
                                      m.utc_us);
  }
  Offset<wire::ViewState> operator()(const ViewState& m) {
    RUNSTONE_ASSERT(m.past || m.seq == 0);
    RUNSTONE_ASSERT(m.seq != 0 || m.utc_us == 0);
    return wire::CreateViewState(b, m.request, m.view, static_cast<std::uint8_t>(m.phase), m.past,
                                 m.seq, m.utc_us, text(m.text));
  }
  Offset<wire::EditRequest> operator()(const EditRequest& m) {
    const Bytes edit = m.fault ? Bytes{} : encode(m.edit);
    return wire::CreateEditRequest(b, m.client_seq, m.submitted_us, bytes_of(b, edit), m.action,
                                   m.is_optional);
  }
  Offset<wire::Commit> operator()(const Commit& m) {
    const CommitEncoder encoder(m);
    return commit(encoder, encoder.all());
  }
  Offset<wire::VeiledCommit> operator()(const VeiledCommit& m) {
    const CommitEncoder encoder(m);
    return veiled_commit(encoder, encoder.all());
  }
  Offset<wire::VeilPatches> operator()(const VeilPatches& m) {
    RUNSTONE_ASSERT(!m.patches.empty() && (m.version.epoch == 0) == (m.version.seq == 0));
    Bytes bytes;
    ByteWriter out(bytes);
    put_patches(out, m.patches, m.version.seq);
    return wire::CreateVeilPatches(b, m.version.epoch, m.version.seq, bytes_of(b, bytes));
  }
  Offset<wire::Reject> operator()(const Reject& m) {
    return wire::CreateReject(b, m.client_seq, static_cast<std::uint8_t>(m.reason), text(m.detail),
                              m.seq);
  }
  Offset<wire::Durable> operator()(const Durable& m) {
    return wire::CreateDurable(b, m.epoch, m.seq, m.is_read_only);
  }
  Offset<wire::DigestCheck> operator()(const DigestCheck& m) {
    return wire::CreateDigestCheck(b, bytes_of(b, encode_digest_checks(m.entries)));
  }
  Offset<wire::Move> operator()(const Move& m) {
    const wire::Pose pose = pose_of(m.pose);
    return wire::CreateMove(b, &pose);
  }
  Offset<wire::PlayerPoses> operator()(const PlayerPoses& m) {
    std::vector<Offset<wire::PlayerPose>> players;
    players.reserve(m.players.size());
    for (const PlayerPose& p : m.players) {
      const wire::Pose pose = pose_of(p.pose);
      players.push_back(wire::CreatePlayerPose(b, p.author, &pose));
    }
    return wire::CreatePlayerPoses(b, b.CreateVector(players));
  }
  Offset<wire::PlayerList> operator()(const PlayerList& m) {
    std::vector<Offset<wire::PlayerName>> players;
    players.reserve(m.players.size());
    for (const PlayerName& p : m.players) {
      const auto name = b.CreateString(p.name);
      const auto key = bytes_of(b, p.key);
      const auto role = p.role.empty() ? 0 : b.CreateString(p.role);
      players.push_back(wire::CreatePlayerName(b, p.author, name, key, role));
    }
    return wire::CreatePlayerList(b, b.CreateVector(players), m.is_change,
                                  m.is_change ? b.CreateVector(m.left) : 0);
  }
  Offset<wire::Ping> operator()(const Ping& m) { return wire::CreatePing(b, m.sent_us); }
  Offset<wire::Pong> operator()(const Pong& m) {
    return wire::CreatePong(b, m.sent_us, m.server_us);
  }
  Offset<wire::Goodbye> operator()(const Goodbye& m) {
    return wire::CreateGoodbye(b, static_cast<std::uint16_t>(m.reason), text(m.text));
  }

  Offset<wire::CommandRequest> operator()(const CommandRequest& m) {
    RUNSTONE_ASSERT(!m.text.empty() && m.text.size() <= kCommandBytesMax);
    return wire::CreateCommandRequest(b, m.id, b.CreateString(m.text));
  }
  Offset<wire::CommandOutput> operator()(const CommandOutput& m) {
    RUNSTONE_ASSERT(m.lines.size() <= kCommandLinesMax);
    std::vector<Offset<flatbuffers::String>> lines;
    lines.reserve(m.lines.size());
    for (const std::string& line : m.lines) lines.push_back(b.CreateString(shown_line(line)));
    return wire::CreateCommandOutput(b, m.id, b.CreateVector(lines), m.is_done, m.is_ok);
  }
  Offset<wire::ReceiveAck> operator()(const ReceiveAck& m) {
    return wire::CreateReceiveAck(b, m.chunk_bytes);
  }
  Offset<wire::UniformChunks> operator()(const UniformChunks& m) {
    return wire::CreateUniformChunks(b, m.view, bytes_of(b, encode_uniform(m.chunks)),
                                     m.chunks.front().key.lod);
  }

  Offset<wire::Permissions> operator()(const Permissions& m) {
    RUNSTONE_ASSERT(!m.role.empty() && m.role.size() <= kGroundNameBytesMax);
    const auto role = b.CreateString(m.role);
    return wire::CreatePermissions(b, role, m.rights, m.edit_volume_max, text(m.edits_refused),
                                   m.edit_budget.per_second, m.edit_budget.burst);
  }
  Offset<wire::ProtectedGround> operator()(const ProtectedGround& m) {
    RUNSTONE_ASSERT(m.removed.size() <= kGroundBoxesMax && m.boxes.size() <= kGroundBoxesMax);
    RUNSTONE_ASSERT(!m.removed.empty() || !m.boxes.empty());
    std::vector<Offset<wire::GroundBox>> boxes;
    boxes.reserve(m.boxes.size());
    for (const GroundBox& box : m.boxes) {
      const auto name = b.CreateString(box.name);
      const auto owner = b.CreateString(box.owner);
      const wire::Corner min(box.box.min.x, box.box.min.y, box.box.min.z);
      const wire::Corner max(box.box.max.x, box.box.max.y, box.box.max.z);
      boxes.push_back(
          wire::CreateGroundBox(b, box.seq, &min, &max, box.priority, box.admits, name, owner));
    }
    const auto removed = b.CreateVector(m.removed);
    return wire::CreateProtectedGround(b, removed, b.CreateVector(boxes));
  }

  Offset<wire::ChatRequest> operator()(const ChatRequest& m) {
    RUNSTONE_ASSERT(!m.text.empty() && m.text.size() <= kChatBytesMax);
    return wire::CreateChatRequest(b, b.CreateString(m.text));
  }
  Offset<wire::ChatLines> operator()(const ChatLines& m) {
    RUNSTONE_ASSERT(!m.lines.empty() && m.lines.size() <= kChatLinesMax);
    std::vector<Offset<wire::ChatLine>> lines;
    lines.reserve(m.lines.size());
    for (const ChatLine& line : m.lines) {
      RUNSTONE_ASSERT(!line.text.empty() && line.text.size() <= kChatBytesMax);
      RUNSTONE_ASSERT(line.kind == ChatLineKind::player || (line.name.empty() && line.author == 0));
      const auto name = line.name.empty() ? 0 : b.CreateString(line.name);
      const auto text = b.CreateString(line.text);
      lines.push_back(wire::CreateChatLine(b, static_cast<std::uint8_t>(line.kind), line.author,
                                           name, text, line.utc_us));
    }
    return wire::CreateChatLines(b, b.CreateVector(lines));
  }
  Offset<wire::ChatWithdrawn> operator()(const ChatWithdrawn& m) {
    RUNSTONE_ASSERT(!m.lines.empty() && m.lines.size() <= kChatWithdrawnMax);
    std::vector<Offset<wire::ChatLineId>> lines;
    lines.reserve(m.lines.size());
    for (const ChatLineId& line : m.lines)
      lines.push_back(wire::CreateChatLineId(b, line.utc_us, b.CreateString(line.name)));
    return wire::CreateChatWithdrawn(b, b.CreateVector(lines));
  }

  Offset<wire::KeyRequest> operator()(const KeyRequest& m) {
    return wire::CreateKeyRequest(b, bytes_of(b, m.slot));
  }
  Offset<wire::SealedKey> operator()(const SealedKey& m) {
    RUNSTONE_ASSERT(!m.sealed.empty() && m.sealed.size() <= kSealedKeyBytesMax);
    return wire::CreateSealedKey(b, bytes_of(b, m.sealed));
  }
  Offset<wire::KeyDeposit> operator()(const KeyDeposit& m) {
    RUNSTONE_ASSERT(!m.sealed.empty() && m.sealed.size() <= kSealedKeyBytesMax);
    const auto slot = bytes_of(b, m.slot);
    const auto sealed = bytes_of(b, m.sealed);
    return wire::CreateKeyDeposit(b, slot, sealed, bytes_of(b, m.signature));
  }
  Offset<wire::KeyDeposited> operator()(const KeyDeposited& m) {
    return wire::CreateKeyDeposited(b, m.seconds, text(m.text));
  }

  Offset<wire::MaterialsAdded> operator()(const MaterialsAdded& m) {
    RUNSTONE_ASSERT(m.first != 0 && !m.rows.empty());
    RUNSTONE_ASSERT(m.first + m.rows.size() <= kMaterialCountMax);
    return wire::CreateMaterialsAdded(b, m.first, material_rows(m.rows, ShapeList()));
  }
  Offset<wire::ShapesGiven> operator()(const ShapesGiven& m) {
    Bytes bytes;
    ByteWriter w(bytes);
    write_given_shapes(w, m.given);
    return wire::CreateShapesGiven(b, bytes_of(b, bytes));
  }
  Offset<wire::TexturesGiven> operator()(const TexturesGiven& m) {
    return wire::CreateTexturesGiven(b, bytes_of(b, encode_textures(m.entries)));
  }
  Offset<wire::TexturesWanted> operator()(const TexturesWanted& m) {
    return wire::CreateTexturesWanted(b, bytes_of(b, encode_hashes(m.hashes)));
  }
  Offset<wire::TextureParts> operator()(const TextureParts& m) {
    return wire::CreateTextureParts(b, bytes_of(b, encode_texture_parts(m.parts)));
  }

  Offset<wire::WorldTime> operator()(const WorldTime& m) {
    RUNSTONE_ASSERT(is_valid(m));
    return wire::CreateWorldTime(b, m.day_ms, m.rate);
  }

  Offset<wire::LogMarksRequest> operator()(const LogMarksRequest& m) {
    RUNSTONE_ASSERT(m.first != 0 && m.first <= m.last);
    RUNSTONE_ASSERT(m.count != 0 && m.count <= kLogMarksMax);
    const VoxelPos at = m.at.value_or(VoxelPos{});
    const wire::Corner voxel(at.x, at.y, at.z);
    return wire::CreateLogMarksRequest(b, m.request, m.first, m.last, m.count,
                                       m.at ? &voxel : nullptr);
  }
  Offset<wire::LogMarks> operator()(const LogMarks& m) {
    RUNSTONE_ASSERT(m.marks.size() <= kLogMarksMax && m.authors.size() <= kLogMarksMax);
    std::vector<wire::LogMark> marks;
    marks.reserve(m.marks.size());
    for (const LogMark& mark : m.marks)
      marks.emplace_back(mark.seq, mark.utc_us, mark.author, static_cast<std::uint8_t>(mark.cause),
                         static_cast<std::uint8_t>(mark.kind));
    std::vector<Offset<wire::LogAuthor>> authors;
    authors.reserve(m.authors.size());
    for (const LogAuthor& author : m.authors)
      authors.push_back(wire::CreateLogAuthor(b, author.author, b.CreateString(author.name)));
    const auto marks_at = b.CreateVectorOfStructs(marks);
    const auto authors_at = b.CreateVector(authors);
    return wire::CreateLogMarks(b, m.request, m.first, marks_at, authors_at, text(m.refusal));
  }
  Offset<wire::RestorePreview> operator()(const RestorePreview& m) {
    RUNSTONE_ASSERT(m.edits.size() <= kRestorePreviewEditsMax);
    std::vector<Offset<wire::EditBytes>> edits;
    edits.reserve(m.edits.size());
    for (const EditDescriptor& edit : m.edits)
      edits.push_back(wire::CreateEditBytes(b, bytes_of(b, encode(edit))));
    RUNSTONE_ASSERT(m.preview.size() <= kPreviewIdBytesMax);
    const auto preview = b.CreateString(m.preview);
    return wire::CreateRestorePreview(b, m.command, preview, m.voxels, m.chunks,
                                      b.CreateVector(edits), m.is_cut);
  }

  Offset<wire::PreviewShare> operator()(const PreviewShare& m) {
    return wire::CreatePreviewShare(b, preview_list(m.edits), stroke_bytes(m.stroke));
  }
  Offset<wire::PlayerPreview> operator()(const PlayerPreview& m) {
    return wire::CreatePlayerPreview(b, m.author, preview_list(m.edits), stroke_bytes(m.stroke));
  }

  Offset<wire::Resume> operator()(const Resume& m) { return wire::CreateResume(b, m.resolved); }
  Offset<wire::Resumed> operator()(const Resumed& /*m*/) { return wire::CreateResumed(b); }

  Offset<wire::FollowRequest> operator()(const FollowRequest& m) {
    const auto address = optional_text(m.player_address);
    const auto page = optional_text(m.page_address);
    return wire::CreateFollowRequest(b, m.after.epoch, m.after.seq, address, page);
  }
  Offset<wire::FollowAnswer> operator()(const FollowAnswer& m) {
    return wire::CreateFollowAnswer(b, m.head);
  }
  Offset<wire::LogPart> operator()(const LogPart& m) {
    RUNSTONE_ASSERT(m.records.size() <= kLogPartRecordsMax);
    RUNSTONE_ASSERT(m.players.size() <= kLogPartRowsMax && m.names.size() <= kLogPartRowsMax);
    std::vector<Offset<wire::LogPlayer>> players;
    players.reserve(m.players.size());
    for (const LogPlayer& player : m.players) {
      const auto key = bytes_of(b, player.key);
      players.push_back(wire::CreateLogPlayer(b, player.author, key, b.CreateString(player.name)));
    }
    std::vector<Offset<wire::LogName>> names;
    names.reserve(m.names.size());
    for (const LogName& name : m.names) {
      const auto folded = b.CreateString(name.folded);
      const auto shown = b.CreateString(name.name);
      const auto key = bytes_of(b, name.key);
      names.push_back(wire::CreateLogName(b, folded, shown, key, name.is_release));
    }
    std::vector<Offset<wire::LogRecordBytes>> records;
    records.reserve(m.records.size());
    for (const LogPartRecord& part : m.records) {
      const auto record = bytes_of(b, encode_record(part.record));
      records.push_back(wire::CreateLogRecordBytes(b, record, part.submitted_us));
    }
    const auto players_at = b.CreateVector(players);
    const auto names_at = b.CreateVector(names);
    return wire::CreateLogPart(b, m.epoch, players_at, names_at, b.CreateVector(records));
  }
  Offset<wire::RelayOpen> operator()(const RelayOpen& m) {
    RUNSTONE_ASSERT(!m.name.empty() && m.name.size() <= kPlayerNameBytesMax);
    const auto key = bytes_of(b, m.key);
    const auto name = b.CreateString(m.name);
    const auto ticket = optional_text(m.ticket);
    const auto password_key = optional_bytes(m.password_key);
    const wire::Pose pose = pose_of(m.pose);
    return wire::CreateRelayOpen(b, m.session, m.address, m.is_encrypted, key, m.instance, name,
                                 m.features, m.author, &pose, ticket, password_key);
  }
  Offset<wire::Relay> operator()(const Relay& m) {
    RUNSTONE_ASSERT(!m.sessions.empty() && m.sessions.size() <= kRelaySessionsMax);
    const auto sessions = b.CreateVector(m.sessions);
    const auto body = bytes_of(b, *m.message.bytes);
    return wire::CreateRelay(b, sessions, wire_number(m.message.kind), body);
  }
  Offset<wire::RelayClose> operator()(const RelayClose& m) {
    return wire::CreateRelayClose(b, m.session, m.reason, text(m.text));
  }
  Offset<wire::RelayCharge> operator()(const RelayCharge& m) {
    return wire::CreateRelayCharge(b, m.session, m.bytes);
  }
  Offset<wire::Servers> operator()(const Servers& m) {
    RUNSTONE_ASSERT(m.servers.size() <= kServersMax && m.here <= m.servers.size());
    std::vector<Offset<wire::ServerEntry>> servers;
    servers.reserve(m.servers.size());
    for (const ServerEntry& server : m.servers) {
      RUNSTONE_ASSERT(is_player_address(server.address) && is_page_address(server.page));
      const auto address = b.CreateString(server.address);
      servers.push_back(
          wire::CreateServerEntry(b, address, optional_text(server.page), server.players));
    }
    return wire::CreateServers(b, b.CreateVector(servers), m.here);
  }

  Offset<wire::BuildsRequest> operator()(const BuildsRequest& m) {
    RUNSTONE_ASSERT(m.before != 0 && m.count != 0 && m.count <= kListedBuildsMax);
    const auto name = optional_text(m.name);
    const auto author = optional_text(m.author);
    const auto tag = optional_text(m.tag);
    return wire::CreateBuildsRequest(b, m.request, name, author, tag, m.before, m.count);
  }
  Offset<wire::Builds> operator()(const Builds& m) {
    RUNSTONE_ASSERT(m.builds.size() <= kListedBuildsMax);
    std::vector<Offset<wire::ListedBuild>> builds;
    builds.reserve(m.builds.size());
    for (const ListedBuild& build : m.builds) {
      Bytes info;
      ByteWriter w(info);
      write_build_info(w, build.info);
      const auto info_at = bytes_of(b, info);
      const auto name = optional_text(build.added_by_name);
      builds.push_back(wire::CreateListedBuild(b, build.number, info_at, build.touched,
                                               build.file_bytes, build.added_by, name));
    }
    const auto builds_at = b.CreateVector(builds);
    return wire::CreateBuilds(b, m.request, builds_at, m.has_more, m.total, text(m.refusal));
  }
  Offset<wire::BuildPieceRequest> operator()(const BuildPieceRequest& m) {
    RUNSTONE_ASSERT(m.number != 0 && m.offset % kBuildPieceBytes == 0);
    return wire::CreateBuildPieceRequest(b, m.request, m.number, m.offset);
  }
  Offset<wire::BuildPiece> operator()(const BuildPiece& m) {
    RUNSTONE_ASSERT(m.bytes.size() <= kBuildPieceBytes && m.bytes.empty() != m.refusal.empty());
    const auto bytes = bytes_of(b, m.bytes);
    return wire::CreateBuildPiece(b, m.request, bytes, text(m.refusal));
  }
  Offset<wire::BuildOffer> operator()(const BuildOffer& m) {
    return wire::CreateBuildOffer(b, m.request, m.file_bytes);
  }
  Offset<wire::BuildUpload> operator()(const BuildUpload& m) {
    RUNSTONE_ASSERT(!m.bytes.empty() && m.bytes.size() <= kBuildUploadBytesMax);
    return wire::CreateBuildUpload(b, m.request, m.offset, bytes_of(b, m.bytes));
  }
  Offset<wire::BuildAnswer> operator()(const BuildAnswer& m) {
    RUNSTONE_ASSERT(m.number == 0 || m.refusal.empty());
    return wire::CreateBuildAnswer(b, m.request, m.received, m.number, text(m.refusal));
  }

  Offset<flatbuffers::Vector<std::uint8_t>> preview_list(const std::vector<EditDescriptor>& edits) {
    const Bytes list = encode_preview(edits);
    RUNSTONE_ASSERT(edits.size() <= kPreviewEditsMax && list.size() <= kPreviewListBytesMax);
    return bytes_of(b, list);
  }

  /// Returns no field if there is no stroke.
  Offset<flatbuffers::Vector<std::uint8_t>> stroke_bytes(const std::optional<BrushStroke>& stroke) {
    if (!stroke) return 0;
    const Bytes bytes = encode_stroke(*stroke);
    RUNSTONE_ASSERT(bytes.size() <= kPreviewStrokeBytesMax);
    return bytes_of(b, bytes);
  }

  template <class Rows>
  auto material_rows(const Rows& materials, const ShapeList& shapes)
      -> Offset<flatbuffers::Vector<Offset<wire::MaterialRow>>> {
    std::vector<Offset<wire::MaterialRow>> rows;
    rows.reserve(materials.size());
    for (const auto& row : materials) {
      const auto& c = row.colour;
      std::uint32_t rgba = 0;
      for (unsigned i = 0; i < 4; ++i) rgba |= static_cast<std::uint32_t>(c[i]) << (8 * i);
      const auto name = b.CreateString(row.name);
      const MaterialLook given = row.look.value_or(MaterialLook{});
      const wire::MaterialLook look(given.variation, given.grain, given.roughness, given.emission,
                                    static_cast<std::uint8_t>(given.pattern));
      rows.push_back(wire::CreateMaterialRow(
          b, name, rgba, static_cast<std::uint8_t>(row.visibility),
          static_cast<std::uint8_t>(row.body), row.look ? &look : nullptr, shapes.number(row)));
    }
    return b.CreateVector(rows);
  }
  template <std::size_t N>
  auto optional_bytes(const std::optional<std::array<std::uint8_t, N>>& bytes)
      -> Offset<flatbuffers::Vector<std::uint8_t>> {
    if (!bytes) return 0;
    return bytes_of(b, *bytes);
  }
  /// An empty text is left out.
  Offset<flatbuffers::String> optional_text(const std::string& t) {
    return t.empty() ? Offset<flatbuffers::String>() : b.CreateString(t);
  }
  Offset<wire::Chunks> chunks(std::uint32_t view, std::span<const ChunkEntry> entries) {
    RUNSTONE_ASSERT(view != 0);
    return wire::CreateChunks(b, view, bytes_of(b, list_of(entries)), entries.front().key.lod);
  }
  Offset<wire::Commit> commit(const CommitEncoder& edits, std::span<const std::uint32_t> which) {
    RUNSTONE_ASSERT(edits.epoch() != 0);
    return wire::CreateCommit(b, edits.epoch(), bytes_of(b, edits.list(which)));
  }
  Offset<wire::VeiledCommit> veiled_commit(const CommitEncoder& edits,
                                           std::span<const std::uint32_t> which) {
    RUNSTONE_ASSERT(edits.epoch() != 0);
    return wire::CreateVeiledCommit(b, edits.epoch(), bytes_of(b, edits.list(which)));
  }
  /// Returns the line with "?" for each byte that is not printable: a line may name a file, and
  /// file names hold any bytes.
  static std::string shown_line(const std::string& line) {
    std::string shown = line;
    if (!is_printable_utf8(shown)) {
      for (char& c : shown) c = c >= ' ' && c <= '~' ? c : '?';
    }
    return std::string(cut_utf8(shown, kCommandLineBytesMax));
  }
  /// Texts are for people, so a text that is too long is cut.
  Offset<flatbuffers::String> text(const std::string& t) {
    const std::string_view cut = cut_utf8(t, kTextBytesMax);
    return b.CreateString(cut.data(), cut.size());
  }
};

/// Returns the builder of this thread, empty. Its buffer is reused from message to message.
FlatBufferBuilder& cleared_builder() {
  thread_local FlatBufferBuilder builder(kBuilderBytes);
  builder.Clear();
  return builder;
}

template <class Table>
EncodedMessage finish(FlatBufferBuilder& b, MessageKind kind, Offset<Table> body) {
  b.Finish(body);
  // In each class the server's limit is the larger one.
  RUNSTONE_ASSERT(b.GetSize() <= message_bytes_max(Sender::server, info_of(kind).frame_class));
  const std::uint8_t* first = b.GetBufferPointer();
  auto bytes = std::make_shared<const Bytes>(first, first + b.GetSize());
  // After a huge message the builder gives its memory back.
  if (bytes->size() > kBuilderBytesKept) b.Reset();
  return {kind, std::move(bytes)};
}

}  // namespace

EncodedMessage encode_message(const Message& message) {
  FlatBufferBuilder& b = cleared_builder();
  return std::visit([&](const auto& m) { return finish(b, message.index(), BodyBuilder{b}(m)); },
                    message);
}

EncodedMessage join_entries(std::uint32_t view, std::span<const ChunkEntry> entries) {
  FlatBufferBuilder& b = cleared_builder();
  return finish(b, kKindOf<Chunks>, BodyBuilder{b}.chunks(view, entries));
}

EncodedMessage encode_message(const CommitEncoder& commit, std::span<const std::uint32_t> edits) {
  FlatBufferBuilder& b = cleared_builder();
  if (commit.is_veiled())
    return finish(b, kKindOf<VeiledCommit>, BodyBuilder{b}.veiled_commit(commit, edits));
  return finish(b, kKindOf<Commit>, BodyBuilder{b}.commit(commit, edits));
}

}  // namespace runstone
