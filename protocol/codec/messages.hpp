// Messages as plain structs, with the functions that encode and decode them. A decoded struct is
// valid: sizes, ranges, enum values, descriptor bytes and chunk runs were checked. There are two
// exceptions:
//   - an EditRequest whose descriptor is not valid has a `fault` in place of the edit;
//   - the digest of a snapshot is not compared with its voxels.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/core/budget.hpp"
#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/digest.hpp"
#include "common/core/ids.hpp"
#include "common/core/public_key.hpp"
#include "common/core/result.hpp"
#include "common/core/tile_keys.hpp"
#include "common/core/world_pos.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/height_limits.hpp"
#include "common/materials/material_table.hpp"
#include "common/rights/join_password.hpp"
#include "common/runs/chunk.hpp"
#include "common/veil/veil_patch.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "protocol/codec/build_messages.hpp"
#include "protocol/codec/chat_messages.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/key_transfer_messages.hpp"
#include "protocol/codec/log_mark_messages.hpp"
#include "protocol/codec/pose.hpp"
#include "protocol/codec/preview_messages.hpp"
#include "protocol/codec/restore_preview_messages.hpp"
#include "protocol/codec/rights_messages.hpp"
#include "protocol/codec/server_list.hpp"
#include "protocol/codec/server_messages.hpp"
#include "protocol/codec/texture_messages.hpp"
#include "protocol/limits.hpp"

namespace runstone {

using Nonce = std::array<std::uint8_t, kNonceBytes>;
using Signature = std::array<std::uint8_t, kSignatureBytes>;
using WorldId = std::array<std::uint8_t, kWorldIdBytes>;
/// Made from a password and a salt (password_key.hpp). Whoever has it can join like somebody who
/// knows the password, in worlds with this salt.
using PasswordKey = std::array<std::uint8_t, kPasswordKeyBytes>;

struct Hello {
  std::uint32_t protocol = kProtocolVersion;
  PublicKey key{};
  ClientInstance instance = 0;
  Nonce nonce{};
  std::string name;
  std::uint8_t encodings = kEncodingsKnown;  // a bit per ChunkEncoding: 1 << (encoding - 1)
  std::uint64_t features = 0;                // as sent: unknown bits are possible
  friend bool operator==(const Hello&, const Hello&) = default;
};
/// How fast a player may edit. docs/protocol.md has the prices of edits.
using EditBudget = Budget;
struct Welcome {
  std::uint32_t protocol = kProtocolVersion;
  WorldId world_id{};
  Epoch epoch = 0;
  Sequence durable = 0, head = 0;
  std::uint16_t chunk_edge = 32;
  HeightLimits heights;  // limits of edits
  WorldPos spawn;
  MaterialTable materials;  // without the feature shapes, encode_message() leaves shapes out
  PublicKey server_key{};
  Nonce challenge{};
  Signature signature{};
  ChunkEncoding encoding = ChunkEncoding::raw;
  std::uint64_t edit_volume_max = 0;
  EditBudget edit_budget;  // of the player's key, for all of its sessions together
  std::uint8_t view_radius_max = 0;
  std::uint64_t features = 0;                 // in force for this session; a subset of Hello's
  std::optional<PasswordSalt> password_salt;  // nullopt: the world has no password
  std::uint8_t tile_levels_max = kTileLevelMax;
  /// With the feature large actions: the edits that the session may have under way, and the bytes of
  /// their descriptors. Otherwise 0.
  std::uint32_t waiting_edits_max = 0, waiting_edit_bytes_max = 0;
  friend bool operator==(const Welcome&, const Welcome&) = default;
};
struct ClientAuth {
  Signature signature{};
  std::string ticket;  // an invite token (invite_token.hpp); empty: none
  std::optional<PasswordKey> password_key = std::nullopt;
  friend bool operator==(const ClientAuth&, const ClientAuth&) = default;
};
struct SessionAccepted {
  AuthorId author = 0;
  ClientSequence resolved = 0;
  /// The rules by which the server makes tiles. Tiles that were made by other rules are not
  /// claimed. 0: the server takes no claims of tiles.
  std::uint32_t tile_rules = 0;
  /// Where the player was last in this world; nullopt: the player begins at the spawn.
  std::optional<Pose> place = std::nullopt;
  friend bool operator==(const SessionAccepted&, const SessionAccepted&) = default;
};

/// The chunks that a client wants: those with dx^2 + dz^2 <= radius_h^2 and |dy| <= radius_v around
/// `centre`. The direction is a hint: the server sends what lies in the cone first.
struct View {
  std::uint32_t number = 1;  // from 1, ascending within a session
  ChunkCoord centre;
  std::uint8_t radius_h = 0, radius_v = 0;
  std::uint16_t yaw = 0;   // as in Pose
  std::int16_t pitch = 0;  // as in Pose
  /// Half the opening angle of the cone that the client sees; 65536 is a turn. 0 .. kViewConeMax; 0
  /// means all around.
  std::uint16_t cone = 0;
  /// The client wants tiles of the levels 1 .. levels, too: 0 .. kTileLevelMax (view_tiles.hpp).
  std::uint8_t levels = 0;
  friend bool operator==(const View&, const View&) = default;
  bool contains(ChunkCoord c) const {
    const std::int64_t dx = std::int64_t{c.x} - centre.x;
    const std::int64_t dy = std::int64_t{c.y} - centre.y;
    const std::int64_t dz = std::int64_t{c.z} - centre.z;
    return dx * dx + dz * dz <= std::int64_t{radius_h} * radius_h && dy <= radius_v &&
           -dy <= radius_v;
  }
  /// Returns true if both views contain the same chunks and tiles. Directions are ignored.
  bool same_chunks(const View& other) const {
    return centre == other.centre && radius_h == other.radius_h && radius_v == other.radius_v &&
           levels == other.levels;
  }
};
struct ChunkRequest {
  std::vector<ChunkKey> keys;  // 1 .. kChunkRequestKeysMax, strictly ascending
  friend bool operator==(const ChunkRequest&, const ChunkRequest&) = default;
};
struct ChunkSnapshot {
  ChunkKey key;
  Chunk chunk;
  friend bool operator==(const ChunkSnapshot&, const ChunkSnapshot&) = default;
};
struct MissingEdit {
  Sequence seq = 0;
  EditDescriptor edit;
  friend bool operator==(const MissingEdit&, const MissingEdit&) = default;
};
/// Replaces a snapshot at `to`: all edits with from < seq <= to.seq that touch the chunk by
/// geometry, in ascending order. The last one is at to.seq.
struct ChunkEdits {
  ChunkKey key;
  Sequence from = 0;
  Version to;
  Digest digest;  // of the chunk at `to`
  std::vector<MissingEdit> edits;
  friend bool operator==(const ChunkEdits&, const ChunkEdits&) = default;
};
/// What a server sends for a chunk that is not of one material.
using ChunkAnswer = std::variant<ChunkSnapshot, ChunkEdits>;
inline const ChunkKey& key_of(const ChunkAnswer& answer) {
  return std::visit([](const auto& a) -> const ChunkKey& { return a.key; }, answer);
}
/// Clients decode this struct. Servers encode each chunk once for all sessions instead, and join
/// the entries of a session to messages: see chunk_entries.hpp.
struct Chunks {
  /// View::number of the newest view in force when the chunks were queued, so that a client can
  /// ignore chunks that it has forgotten and requested again since. The fields `view` of other
  /// messages have this meaning, too.
  std::uint32_t view = 1;
  /// 1 .. kChunksPerMessageMax, strictly ascending by key, all of one level of detail. Tiles come
  /// as snapshots only.
  std::vector<ChunkAnswer> chunks;
  friend bool operator==(const Chunks&, const Chunks&) = default;
};
/// The snapshot of a chunk of one material. Its digest follows from the material.
struct UniformChunk {
  ChunkKey key;
  Material material = kEmpty;
  Version version;
  friend bool operator==(const UniformChunk&, const UniformChunk&) = default;
};
struct UniformChunks {
  std::uint32_t view = 1;
  // 1 .. kUniformChunksMax, strictly ascending by key, all of one level of detail
  std::vector<UniformChunk> chunks;
  friend bool operator==(const UniformChunks&, const UniformChunks&) = default;
};

/// Why the server cannot send a chunk. Values are on the wire. Readers accept values that they do
/// not know.
enum class UnavailableReason : std::uint8_t {
  /// The row of the chunk in the server's database is damaged. It stays so until the row is
  /// repaired and the server restarts.
  damaged = 1,
};
/// Returns the name in docs/protocol.md, or "unknown".
const char* to_string(UnavailableReason reason);

/// Names chunks of the view that the server cannot send, so that the client does not wait for them.
struct ChunkUnavailable {
  std::uint32_t view = 1;
  std::vector<ChunkKey> keys;  // 1 .. kUnavailableKeysMax, strictly ascending
  UnavailableReason reason = UnavailableReason::damaged;
  friend bool operator==(const ChunkUnavailable&, const ChunkUnavailable&) = default;
};
/// The claim of a client that it has a chunk at this version.
struct CachedChunk {
  ChunkKey key;
  Version version;
  std::uint64_t digest = 0;  // claim_digest() of the voxels
  friend bool operator==(const CachedChunk&, const CachedChunk&) = default;
};
/// Returns lane 0 of a digest. Its 61 bits find a copy that differs by accident, but for one in
/// 2^61. A copy that differs on purpose harms only the client that claims it, and only until the
/// next DigestCheck.
inline std::uint64_t claim_digest(const Digest& digest) { return digest.lane[0]; }

/// Claims for chunks or tiles of the view in force or of the next view, so that the server need not
/// send them.
struct CachedChunks {
  // 1 .. kCachedChunksMax, strictly ascending by key, all of one level of detail
  std::vector<CachedChunk> chunks;
  friend bool operator==(const CachedChunks&, const CachedChunks&) = default;
};
/// The client's copy at this sequence equals the chunk at the moment when the session was
/// subscribed to it.
struct UnmodifiedChunk {
  ChunkKey key;
  Sequence seq = 0;
  friend bool operator==(const UnmodifiedChunk&, const UnmodifiedChunk&) = default;
};
struct ChunksNotModified {
  std::uint32_t view = 1;
  // 1 .. kChunksNotModifiedMax, strictly ascending by key, all of one level of detail
  std::vector<UnmodifiedChunk> chunks;
  friend bool operator==(const ChunksNotModified&, const ChunksNotModified&) = default;
};
/// Which state of the world a session asks for. Values are on the wire.
enum class HistoryTarget : std::uint8_t { live = 0, sequence = 1, time = 2 };
inline constexpr std::uint8_t kHistoryTargetMax = 2;

/// Asks for the view as it was. A later request replaces the earlier ones.
struct HistoryRequest {
  std::uint32_t request = 1;  // from 1, ascending
  HistoryTarget to = HistoryTarget::live;
  Sequence seq = 0;   // for HistoryTarget::sequence: the last edit to show; 0: before the first one
  TimeUs utc_us = 0;  // for HistoryTarget::time: edits up to this time are shown
  friend bool operator==(const HistoryRequest&, const HistoryRequest&) = default;
};

/// Values are on the wire.
///   - begins: the chunks that follow show this state of the world;
///   - complete: every chunk of the view was answered;
///   - refused: a HistoryRequest changed nothing, and `text` gives the reason.
enum class ViewPhase : std::uint8_t { begins = 1, complete = 2, refused = 3 };
inline constexpr std::uint8_t kViewPhaseMax = 3;

/// Says which state of the world the client sees from this message on: the fields past, seq and
/// utc_us describe it in every phase.
struct ViewState {
  /// The newest HistoryRequest that was answered. 0: none yet; then the state is the live world,
  /// and the phase is not `refused`.
  std::uint32_t request = 0;
  std::uint32_t view = 0;  // number of the newest view in force; 0: none yet, then not `complete`
  ViewPhase phase = ViewPhase::begins;
  bool past = false;  // false: the live world; seq and utc_us are 0 then
  Sequence seq = 0;   // of a past state: its last edit; 0: before the first one
  TimeUs utc_us = 0;  // of a past state: when that edit was ordered; 0 before the first one
  std::string text;
  friend bool operator==(const ViewState&, const ViewState&) = default;
};
struct EditRequest {
  ClientSequence client_seq = 0;
  TimeUs submitted_us = 0;
  EditDescriptor edit;
  /// Why the descriptor's bytes are not a valid descriptor; `edit` then has no meaning. Such a
  /// request is answered with Reject bad_edit. It does not end the session, or a client that offers
  /// its pending edits again would never get in.
  std::optional<Error> fault = std::nullopt;
  /// The first edit of the action to which this one belongs, at most client_seq. 0: the edit is an
  /// action by itself.
  ClientSequence action = 0;
  /// The action goes on without this edit if it is rejected. Otherwise its rejection ends the
  /// action. Only with the feature large actions.
  bool is_optional = false;
  /// Two requests with faults are equal whatever the faults are: encode_message() does not keep the
  /// bytes.
  friend bool operator==(const EditRequest& a, const EditRequest& b) {
    return a.client_seq == b.client_seq && a.submitted_us == b.submitted_us && a.edit == b.edit &&
           a.fault.has_value() == b.fault.has_value() && a.action == b.action &&
           a.is_optional == b.is_optional;
  }
};
struct OrderedEdit {
  Sequence seq = 0;
  OperationId op;
  Cause cause = Cause::player;
  TimeUs submitted_us = 0, ordered_us = 0;  // on the server's steady clock
  EditDescriptor edit;
  /// Of each touched chunk, the sequence before this edit. In touched_chunks() order.
  std::vector<Sequence> previous;
  /// The earlier edit that a rollback, undo or redo answers, or the first edit of the player's
  /// action; 0: none.
  Sequence subject = 0;
  friend bool operator==(const OrderedEdit&, const OrderedEdit&) = default;
};
/// Edits that were ordered together, or those of them that a session gets.
struct Commit {
  Epoch epoch = 0;
  std::vector<OrderedEdit> edits;  // their sequences ascend
  friend bool operator==(const Commit&, const Commit&) = default;
};

/// A change of a chunk that a client holds with a veil (docs/veil.md).
struct ChunkPatch {
  ChunkCoord at;  // level of detail 0
  /// Of the chunk before the patch. It is the sequence that the chunk gets if the patch follows the
  /// descriptor of its entry, or a record that is the newest of the log.
  Sequence previous = 0;
  VeilPatch patch;  // in the order kVeilOrder, not empty
  friend bool operator==(const ChunkPatch&, const ChunkPatch&) = default;
};
/// What a veiled session gets of an edit.
struct VeiledEdit {
  /// Without has_edit, `edit` and `previous` are empty: the session gets the result of the edit, or
  /// a receipt for its own edit, which changes no shown voxel.
  OrderedEdit ordered;
  bool has_edit = false;
  std::vector<ChunkPatch> patches;  // applied after the edit; at most kVeilPatchesMax, ascending
  friend bool operator==(const VeiledEdit&, const VeiledEdit&) = default;
};
/// The Commit of a veiled session.
struct VeiledCommit {
  Epoch epoch = 0;
  std::vector<VeiledEdit> edits;  // their sequences ascend
  friend bool operator==(const VeiledCommit&, const VeiledCommit&) = default;
};
/// Patches without an edit, because a neighbour became known. The chunks get this version.
struct VeilPatches {
  Version version;
  std::vector<ChunkPatch> patches;  // 1 .. kVeilPatchesMax, ascending
  friend bool operator==(const VeilPatches&, const VeilPatches&) = default;
};

/// Values are on the wire. Every reason but already_resolved uses up the client sequence: another
/// attempt takes a new one.
enum class RejectReason : std::uint8_t {
  busy = 1,              // the log is full, or the server is stopping
  already_resolved = 2,  // the client sequence was applied or rejected before
  unknown_material = 3,
  too_large = 4,  // too many voxels or touched chunks
  out_of_reach = 5,
  not_permitted = 6,  // the role of the player, a restriction or protected ground; text says which
  rate_limited = 7,
  bad_edit = 8,       // not a valid descriptor
  outside_world = 9,  // a voxel lies above or below the height limits
  // With the feature large actions.
  unknown_action = 10,  // the log does not have the first edit of the action: begin another one
  action_ended = 11,    // the player has undone the action
};
inline constexpr std::uint8_t kRejectReasonMax = 11;
/// Returns the name in docs/protocol.md, or "unknown".
const char* to_string(RejectReason reason);

/// The answer to an edit for which no commit will follow: the edit was rejected, or
/// (already_resolved) it was applied or rejected earlier.
struct Reject {
  ClientSequence client_seq = 0;
  RejectReason reason = RejectReason::busy;
  std::string detail;
  /// For already_resolved: if the edit was applied, then at this sequence or before.
  Sequence seq = 0;
  friend bool operator==(const Reject&, const Reject&) = default;
};
struct Durable {
  Epoch epoch = 0;
  Sequence seq = 0;
  bool is_read_only = false;  // the disk is full: every edit is rejected busy
  friend bool operator==(const Durable&, const Durable&) = default;
};
struct DigestCheckEntry {
  ChunkKey key;
  Version version;
  Digest digest;
  friend bool operator==(const DigestCheckEntry&, const DigestCheckEntry&) = default;
};
struct DigestCheck {
  std::vector<DigestCheckEntry> entries;  // 1 .. kDigestCheckEntriesMax, strictly ascending by key
  friend bool operator==(const DigestCheck&, const DigestCheck&) = default;
};
struct Move {
  Pose pose;
  friend bool operator==(const Move&, const Move&) = default;
};
struct PlayerPose {
  AuthorId author = 0;
  Pose pose;
  friend bool operator==(const PlayerPose&, const PlayerPose&) = default;
};
struct PlayerPoses {
  std::vector<PlayerPose> players;
  friend bool operator==(const PlayerPoses&, const PlayerPoses&) = default;
};
struct PlayerName {
  AuthorId author = 0;
  std::string name;
  PublicKey key{};
  std::string role = {};  // 0 .. kGroundNameBytesMax bytes; empty: the server does not name it
  friend bool operator==(const PlayerName&, const PlayerName&) = default;
};
/// The players in the world: all of them, or the changes since the last list.
struct PlayerList {
  std::vector<PlayerName> players;  // of a change: those who joined, or changed name or role
  bool is_change = false;
  std::vector<AuthorId> left;  // of a change only: those who left
  friend bool operator==(const PlayerList&, const PlayerList&) = default;
};
struct Ping {
  TimeUs sent_us = 0;
  friend bool operator==(const Ping&, const Ping&) = default;
};
struct Pong {
  TimeUs sent_us = 0, server_us = 0;
  friend bool operator==(const Pong&, const Pong&) = default;
};

/// Values are on the wire and in docs/protocol.md.
enum class GoodbyeReason : std::uint16_t {
  closing = 1,         // the sender ends normally
  wrong_protocol = 2,  // text names both versions
  malformed_frame = 3,
  malformed_message = 4,
  unexpected_message = 5,  // valid, but not in this stage or without its feature
  not_authenticated = 6,
  already_connected = 7,  // the same key and instance connected again
  server_full = 8,
  timed_out = 9,
  flooding = 10,  // more messages, claims or requests for keys than the limits allow
  internal = 11,
  name_refused = 12,  // the player may not have this name; text says why
  not_admitted = 13,  // a ban, a kick, or a role that may not join; text says which
};
inline constexpr std::uint16_t kGoodbyeReasonMax = 13;
/// Returns the name in docs/protocol.md, or "unknown".
const char* to_string(GoodbyeReason reason);

struct Goodbye {
  GoodbyeReason reason = GoodbyeReason::closing;
  std::string text;
  friend bool operator==(const Goodbye&, const Goodbye&) = default;
};

/// One line for the server to execute. A session has one command at a time: the next request
/// follows the last output.
struct CommandRequest {
  std::uint32_t id = 0;  // chosen by the client; the outputs carry it
  std::string text;      // 1 .. kCommandBytesMax bytes
  friend bool operator==(const CommandRequest&, const CommandRequest&) = default;
};
struct CommandOutput {
  std::uint32_t id = 0;
  /// At most kCommandLinesMax lines, each of at most kCommandLineBytesMax bytes.
  std::vector<std::string> lines;
  bool is_done = false;  // the last output of its request
  bool is_ok = false;    // valid if is_done: the command succeeded
  friend bool operator==(const CommandOutput&, const CommandOutput&) = default;
};

/// Acknowledges terrain, so that the server can pace what follows.
struct ReceiveAck {
  /// Bytes read of frames of the class chunks, headers included, since the stream began.
  std::uint64_t chunk_bytes = 1;
  friend bool operator==(const ReceiveAck&, const ReceiveAck&) = default;
};

/// New rows of the material table. It has the class of the edits, so it precedes the commits that
/// use the materials. A chunk with a new material may overtake it.
struct MaterialsAdded {
  Material first = 1;             // id of the first row; at least 1
  std::vector<MaterialRow> rows;  // at least 1, with different names; first + rows <= 65536
  friend bool operator==(const MaterialsAdded&, const MaterialsAdded&) = default;
};

/// Shapes of materials that were cubes. It has the class of the edits, and follows the materials.
struct ShapesGiven {
  GivenShapes given;
  friend bool operator==(const ShapesGiven&, const ShapesGiven&) = default;
};

/// Another server orders the edits of the session from now on. What the client sent before may be
/// lost. The client answers with Resumed, and offers the edits again that have no answer.
struct Resume {
  ClientSequence resolved = 0;  // as SessionAccepted::resolved
  friend bool operator==(const Resume&, const Resume&) = default;
};
/// Answers a Resume. Edits that precede it are ignored.
struct Resumed {
  friend bool operator==(const Resumed&, const Resumed&) = default;
};

/// The order is that of the enum Kind in the schema. WorldTime is that of common/core: the clock of
/// the world, when the message was sent.
using Message = std::variant<
    Hello, Welcome, ClientAuth, SessionAccepted, View, ChunkRequest, Chunks, EditRequest, Commit,
    Reject, Durable, DigestCheck, Move, PlayerPoses, PlayerList, Ping, Pong, Goodbye,
    ChunkUnavailable, HistoryRequest, ViewState, CommandRequest, CommandOutput, ReceiveAck,
    UniformChunks, CachedChunks, ChunksNotModified, Permissions, ProtectedGround, ChatRequest,
    ChatLines, KeyRequest, SealedKey, KeyDeposit, KeyDeposited, MaterialsAdded, LogMarksRequest,
    LogMarks, RestorePreview, PreviewShare, PlayerPreview, FollowRequest, FollowAnswer, LogPart,
    RelayOpen, Relay, RelayClose, RelayCharge, Resume, Resumed, Servers, BuildsRequest, Builds,
    BuildPieceRequest, BuildPiece, BuildOffer, BuildUpload, BuildAnswer, ShapesGiven, TexturesGiven,
    TexturesWanted, TextureParts, WorldTime, ChatWithdrawn, VeiledCommit, VeilPatches>;

/// Returns true if the snapshot's digest is the digest of its voxels. Cost: O(runs).
inline bool digest_matches(const ChunkSnapshot& snapshot) {
  return digest_of(snapshot.chunk.voxels) == snapshot.chunk.digest;
}

/// Serialises a message as a FlatBuffers buffer of its table in protocol/schema/runstone.fbs. Chunk
/// snapshots are `raw`; see chunk_entries.hpp for the other encodings. Requires what
/// decode_message() demands, with these exceptions:
///   - reject details, goodbye texts and lines of command output that are too long are cut;
///   - in lines of command output, bytes that are not printable become "?";
///   - a request with a fault gets empty descriptor bytes.
/// Thread: any.
EncodedMessage encode_message(const Message& message);

/// Returns the claims as messages, each within the limits of a client's control message. Requires
/// chunks strictly ascending by key.
std::vector<Message> cached_chunks_messages(std::span<const CachedChunk> chunks);

/// Decodes one message. Requires a kind that the sender may send, and 8-aligned bytes; FrameReader
/// delivers both. `chunk_edge` is the edge of the world's chunks, 0 before Welcome. With an edge,
/// the function also rejects snapshots of another size, keys outside the world, and commits that do
/// not list one previous sequence for each touched chunk. Of a snapshot's digest it checks only the
/// range; see digest_matches(). A Hello or Welcome of another protocol version yields only that
/// version, because its other fields may have another meaning. Memory is bounded by a small
/// multiple of the bytes; for chunks see decode_chunk(). Thread: any.
Result<Message> decode_message(Sender sender, MessageKind kind, ByteView bytes,
                               std::uint16_t chunk_edge);

}  // namespace runstone
