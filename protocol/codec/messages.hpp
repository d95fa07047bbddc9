// Messages as plain structs, and the one way from bytes to them and back. A decode ends validated: sizes,
// ranges, enum values, descriptor bytes and chunk runs are checked before anybody sees the struct.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/digest.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/height_limits.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/chunk_codec.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/limits.hpp"

namespace runstone {

using PublicKey = std::array<std::uint8_t, kKeyBytes>;
using Nonce = std::array<std::uint8_t, kNonceBytes>;
using Signature = std::array<std::uint8_t, kSignatureBytes>;
using WorldId = std::array<std::uint8_t, kWorldIdBytes>;

struct WorldPos {  // voxels; a player's eye or feet, not a voxel
  double x = 0, y = 0, z = 0;
  friend bool operator==(const WorldPos&, const WorldPos&) = default;
};
struct Pose {
  WorldPos at;
  std::uint16_t yaw = 0;   // 65536 a turn, 0 looks along +z, growing towards +x
  std::int16_t pitch = 0;  // 32768 is 180 degrees, positive looks up
  friend bool operator==(const Pose&, const Pose&) = default;
};

struct Hello {
  std::uint32_t protocol = kProtocolVersion;
  PublicKey key{};
  ClientInstance instance = 0;
  Nonce nonce{};
  std::string name;
  std::uint8_t encodings = kEncodingsKnown;  // bit per ChunkEncoding: 1 << (encoding - 1)
  std::uint64_t features = 0;                // as sent: may have bits that this build does not know
  friend bool operator==(const Hello&, const Hello&) = default;
};
struct Welcome {
  std::uint32_t protocol = kProtocolVersion;
  WorldId world_id{};
  Epoch epoch = 0;
  Sequence durable = 0, head = 0;
  std::uint16_t chunk_edge = 32;
  HeightLimits heights;  // of edits
  WorldPos spawn;
  MaterialTable materials;
  PublicKey server_key{};
  Nonce challenge{};
  Signature signature{};
  ChunkEncoding encoding = ChunkEncoding::raw;
  std::uint64_t edit_volume_max = 0;
  std::uint8_t view_radius_max = 0;
  std::uint64_t features = 0;  // of hello's, those in force
  friend bool operator==(const Welcome&, const Welcome&) = default;
};
struct ClientAuth {
  Signature signature{};
  friend bool operator==(const ClientAuth&, const ClientAuth&) = default;
};
struct SessionAccepted {
  AuthorId author = 0;
  ClientSequence resolved = 0;
  friend bool operator==(const SessionAccepted&, const SessionAccepted&) = default;
};

/// What a client wants to see: chunks with dx^2 + dz^2 <= radius_h^2 and |dy| <= radius_v around `centre`; and where it
/// looks, so that what lies there comes first.
struct View {
  ChunkCoord centre;
  std::uint8_t radius_h = 0, radius_v = 0;
  std::uint16_t yaw = 0;  // yaw and pitch as in Pose
  std::int16_t pitch = 0;
  std::uint16_t cone =
      0;  // half the angle of what is seen, 65536 a turn, kViewConeMax at most; 0: all around
  friend bool operator==(const View&, const View&) = default;
  bool contains(ChunkCoord c) const {
    const std::int64_t dx = std::int64_t{c.x} - centre.x;
    const std::int64_t dy = std::int64_t{c.y} - centre.y;
    const std::int64_t dz = std::int64_t{c.z} - centre.z;
    return dx * dx + dz * dz <= std::int64_t{radius_h} * radius_h && dy <= radius_v &&
           -dy <= radius_v;
  }
  /// Whether the same chunks are in both, wherever they look.
  bool same_chunks(const View& other) const {
    return centre == other.centre && radius_h == other.radius_h && radius_v == other.radius_v;
  }
};
struct ChunkRequest {
  std::vector<ChunkKey> keys;
  friend bool operator==(const ChunkRequest&, const ChunkRequest&) = default;
};
/// Server side keeps data encoded (made once by a worker); client side gets the decoded chunk.
struct ChunkSnapshot {
  ChunkKey key;
  Chunk chunk;
  friend bool operator==(const ChunkSnapshot&, const ChunkSnapshot&) = default;
};
/// Chunks of one material each, as snapshots: their digest follows from the material.
struct UniformChunk {
  ChunkKey key;
  Material material = kEmpty;
  Version version;
  friend bool operator==(const UniformChunk&, const UniformChunk&) = default;
};
struct UniformChunks {
  std::vector<UniformChunk>
      chunks;  // 1 .. kUniformChunksMax of lod 0, ascending by is_before_in_list()
  friend bool operator==(const UniformChunks&, const UniformChunks&) = default;
};
/// Column by column: by x, then z, then y.
constexpr bool is_before_in_list(const ChunkCoord& a, const ChunkCoord& b) {
  return a.x != b.x ? a.x < b.x : a.z != b.z ? a.z < b.z : a.y < b.y;
}

/// Why a chunk cannot be had. Values are on the wire; readers take reasons they do not know.
enum class UnavailableReason : std::uint8_t {
  damaged =
      1,  // its row in the server's database is damaged: until that is repaired and the server restarts
};
const char* to_string(UnavailableReason reason);

/// Chunks of the view that the server cannot send: answered by name, so that nobody waits for them.
struct ChunkUnavailable {
  std::vector<ChunkKey> keys;
  UnavailableReason reason = UnavailableReason::damaged;
  friend bool operator==(const ChunkUnavailable&, const ChunkUnavailable&) = default;
};
/// A chunk that a client says it holds.
struct HeldChunk {
  ChunkKey key;
  Version version;
  std::uint64_t digest = 0;  // claim_digest() of its voxels
  friend bool operator==(const HeldChunk&, const HeldChunk&) = default;
};
/// Lane 0 of a digest: 61 bits are enough to find a copy that differs by accident (one in 2^61), and nobody gains by
/// making one that differs on purpose: what a false claim spoils is the claimant's own picture, until the next audit.
inline std::uint64_t claim_digest(const Digest& digest) { return digest.lane[0]; }

/// Chunks of the view that follows, and of those in force: the server need not send what is held. Strictly ascending by
/// key, all of level 0.
struct CachedChunks {
  std::vector<HeldChunk> chunks;
  friend bool operator==(const CachedChunks&, const CachedChunks&) = default;
};
/// The client's copy at this sequence is the chunk as it stood when the session was subscribed.
struct SameChunk {
  ChunkKey key;
  Sequence seq = 0;
  friend bool operator==(const SameChunk&, const SameChunk&) = default;
};
/// Strictly ascending by key, all of level 0.
struct ChunksNotModified {
  std::vector<SameChunk> chunks;
  friend bool operator==(const ChunksNotModified&, const ChunksNotModified&) = default;
};
struct MissingEdit {
  Sequence seq = 0;
  EditDescriptor edit;
  friend bool operator==(const MissingEdit&, const MissingEdit&) = default;
};
/// In place of a snapshot at `to`: all edits that touch the chunk by geometry, from < seq <= to.seq, ascending; the last
/// one is at to.seq.
struct ChunkEdits {
  ChunkKey key;
  Sequence from = 0;
  Version to;
  Digest digest;  // of the chunk at `to`
  std::vector<MissingEdit> edits;
  friend bool operator==(const ChunkEdits&, const ChunkEdits&) = default;
};

/// What a session looks at. Values are on the wire.
enum class HistoryTarget : std::uint8_t { live = 0, sequence = 1, time = 2 };
inline constexpr std::uint8_t kHistoryTargetMax = 2;

/// A wish to see the view as it was. A later one replaces those before it.
struct HistoryRequest {
  std::uint32_t request = 1;  // from 1, ascending
  HistoryTarget to = HistoryTarget::live;
  Sequence seq = 0;   // TravelTo::sequence: the last edit to be seen; 0: before the first one
  TimeUs utc_us = 0;  // TravelTo::time: edits up to here are seen
  friend bool operator==(const HistoryRequest&, const HistoryRequest&) = default;
};

/// begins: the chunks that follow are of this moment. complete: all chunks of the view that differ from what the
/// client holds were sent. refused: nothing changed, and `text` says why. Values are on the wire.
enum class HistoryPhase : std::uint8_t { begins = 1, complete = 2, refused = 3 };
inline constexpr std::uint8_t kHistoryPhaseMax = 3;

struct HistoryState {
  std::uint32_t request = 1;
  HistoryPhase phase = HistoryPhase::begins;
  bool past = false;  // false: the live world
  Sequence seq = 0;   // of a past moment: its last edit; 0 before the first one
  TimeUs utc_us = 0;  // when that was ordered
  std::string text;
  friend bool operator==(const HistoryState&, const HistoryState&) = default;
};
struct EditRequest {
  ClientSequence client_seq = 0;
  TimeUs submitted_us = 0;
  EditDescriptor edit;
  friend bool operator==(const EditRequest&, const EditRequest&) = default;
};
struct OrderedEdit {
  OperationId op;
  Cause cause = Cause::player;
  TimeUs submitted_us = 0, ordered_us = 0;  // server steady clock
  EditDescriptor edit;
  std::vector<Sequence>
      previous;          // sequence each touched chunk stood at before, in touched_chunks() order
  Sequence subject = 0;  // as in EditRecord: the earlier edit this one answers; 0: none
  friend bool operator==(const OrderedEdit&, const OrderedEdit&) = default;
};
struct Commit {
  Epoch epoch = 0;
  Sequence first = 0;
  std::vector<OrderedEdit> edits;
  friend bool operator==(const Commit&, const Commit&) = default;
};

/// Values are on the wire. Every reason but already_resolved uses up the client sequence: another attempt
/// takes a new one.
enum class RejectReason : std::uint8_t {
  busy = 1,              // the log is full
  already_resolved = 2,  // this client sequence was applied or rejected before: see the chunks
  unknown_material = 3,
  too_large = 4,  // volume or touched chunks over the limit
  out_of_reach = 5,
  not_permitted = 6,
  rate_limited = 7,
  bad_edit = 8,       // not a valid descriptor
  outside_world = 9,  // a voxel of it lies above or below the world's heights
};
inline constexpr std::uint8_t kRejectReasonMax = 9;
/// The name in docs/protocol.md.
const char* to_string(RejectReason reason);

struct Reject {
  ClientSequence client_seq = 0;
  RejectReason reason = RejectReason::busy;
  std::string detail;
  Sequence seq =
      0;  // already_resolved: if the edit was applied, its sequence is at most this; else 0
  friend bool operator==(const Reject&, const Reject&) = default;
};
struct Durable {
  Epoch epoch = 0;
  Sequence seq = 0;
  friend bool operator==(const Durable&, const Durable&) = default;
};
struct DigestCheckEntry {
  ChunkKey key;
  Version version;
  Digest digest;
  friend bool operator==(const DigestCheckEntry&, const DigestCheckEntry&) = default;
};
struct DigestCheck {
  std::vector<DigestCheckEntry> entries;
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
  friend bool operator==(const PlayerName&, const PlayerName&) = default;
};
/// Who is here: everybody, or what changed since the last roster.
struct PlayerList {
  std::vector<PlayerName> players;  // of a change: who came or has another name
  bool is_change = false;
  std::vector<AuthorId> left;  // of a change only
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
  unexpected_message = 5,  // valid, but not now or not from this side
  not_authenticated = 6,
  already_connected = 7,  // the same key and instance is here
  server_full = 8,
  timed_out = 9,
  flooding = 10,  // faster than the limits
  internal = 11,
};
inline constexpr std::uint16_t kGoodbyeReasonMax = 11;
/// The name in docs/protocol.md.
const char* to_string(GoodbyeReason reason);

struct Goodbye {
  GoodbyeReason reason = GoodbyeReason::closing;
  std::string text;
  friend bool operator==(const Goodbye&, const Goodbye&) = default;
};

/// A line for the server to carry out. One at a time: the next one after the output that is done.
struct CommandRequest {
  std::uint32_t id = 0;  // the client's choice; the outputs carry it
  std::string text;      // 1 .. kCommandBytesMax
  friend bool operator==(const CommandRequest&, const CommandRequest&) = default;
};
struct CommandOutput {
  std::uint32_t id = 0;
  std::vector<std::string> lines;  // kCommandLinesMax at most, each kCommandLineBytesMax
  bool is_done = false;            // the last output of its request
  bool is_ok = false;              // if done: it did what it was asked
  friend bool operator==(const CommandOutput&, const CommandOutput&) = default;
};

/// How much terrain the client has read, so that the server can pace what follows.
struct ReceiveAck {
  std::uint64_t chunk_bytes =
      1;  // of frames of the class chunks, headers included, since the stream began
  friend bool operator==(const ReceiveAck&, const ReceiveAck&) = default;
};

/// Order follows the union of the schema.
using Message =
    std::variant<Hello, Welcome, ClientAuth, SessionAccepted, View, ChunkRequest, ChunkSnapshot,
                 EditRequest, Commit, Reject, Durable, DigestCheck, Move, PlayerPoses, PlayerList,
                 Ping, Pong, Goodbye, ChunkUnavailable, HistoryRequest, HistoryState,
                 CommandRequest, CommandOutput, ReceiveAck, UniformChunks, CachedChunks,
                 ChunksNotModified, ChunkEdits>;

/// Whether the snapshot's digest is that of its voxels. O(runs).
inline bool digest_holds(const ChunkSnapshot& snapshot) {
  return digest_of(snapshot.chunk.voxels) == snapshot.chunk.digest;
}

/// The class every message of this kind travels in: edit requests, commits, rejects, durable and ready in
/// `edits`, snapshots and what stands in their place in `chunks`, the rest in `control`. So durable stays
/// behind the commits it speaks of, neither can overtake the ready that opens their session, and the last
/// word on a chunk comes last.
FrameClass frame_class_of(const Message& message);

/// Serialises a message: FlatBuffers of protocol/schema/runstone.fbs, chunk snapshots as `raw` (see
/// encode_snapshot()). Requires what decode_message() demands, but for texts: reject details, goodbye
/// texts and lines of command output that are too long are cut, and what is not printable in those lines
/// becomes "?". Any thread.
EncodedMessage encode_message(const Message& message);

/// A snapshot in the given encoding. Reads runs, makes no dense copy. O(runs).
EncodedMessage encode_snapshot(const ChunkKey& key, const Chunk& chunk, ChunkEncoding encoding);

/// Claims as messages, each within the limits of a client's control message. Requires chunks strictly ascending by key.
std::vector<Message> held_messages(std::span<const HeldChunk> chunks);

/// One message of a class from a sender; `bytes` must be 8-aligned, as FrameReader's are. `chunk_edge` is the
/// world's edge (0 before welcome): snapshots of another size and keys outside the world are refused, and
/// `previous` lists must fit the edits' touched chunks. The digest of a snapshot is only checked for its
/// range: see digest_holds(). A hello or welcome of another protocol version carries nothing but that
/// version, since its other fields may mean something else. Memory is bounded by a small multiple of the
/// bytes, but for chunks: see decode_chunk(). Any thread.
Result<Message> decode_message(Sender sender, FrameClass frame_class, ByteView bytes,
                               std::uint16_t chunk_edge);

}  // namespace runstone
