// The limits of messages and frames. The decoder, the verifier and the queues take them from here.
// Limits of what messages carry are defined with their types: descriptors in
// common/edits/descriptor/edit_descriptor.hpp, materials in common/materials/material_table.hpp,
// chunk volumes in common/runs/extent.hpp, chunk bytes in protocol/chunks/chunk_size.hpp, levels of
// detail in common/core/tile_keys.hpp, world coordinates in common/core/coords.hpp.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/texture.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
#include "common/shapes/shape_bytes.hpp"
#include "protocol/chunks/chunk_size.hpp"

namespace runstone {

inline constexpr std::uint32_t kProtocolVersion = 2;

// Features: optional parts of the protocol, a bit each.
inline constexpr std::uint64_t kFeatureCommands = 1;    // CommandRequest and CommandOutput
inline constexpr std::uint64_t kFeatureReceiveAck = 2;  // ReceiveAck, by which terrain is paced
inline constexpr std::uint64_t kFeatureNames = 4;   // the client keeps its key: it claims its name
inline constexpr std::uint64_t kFeatureRights = 8;  // Permissions and ProtectedGround
inline constexpr std::uint64_t kFeatureChat = 16;   // ChatRequest and ChatLines
inline constexpr std::uint64_t kFeatureKeyTransfer = 32;  // KeyRequest, KeyDeposit, their answers
inline constexpr std::uint64_t kFeatureMaterials = 64;    // MaterialsAdded
inline constexpr std::uint64_t kFeatureLogMarks = 128;    // LogMarksRequest and LogMarks
inline constexpr std::uint64_t kFeatureRestorePreview = 256;  // RestorePreview
inline constexpr std::uint64_t kFeaturePreviews = 512;        // PreviewShare and PlayerPreview
inline constexpr std::uint64_t kFeatureTiles = 1024;  // View.levels, and chunks with a level
inline constexpr std::uint64_t kFeatureResume =
    4096;  // Resume, Resumed; a Durable may raise the epoch
inline constexpr std::uint64_t kFeatureServerList = 8192;  // Servers
// Actions without a bound of edits, which budgets delay; see Welcome::waiting_edits_max.
inline constexpr std::uint64_t kFeatureLargeActions = 32768;
inline constexpr std::uint64_t kFeatureBuilds = 131072;      // BuildsRequest to BuildAnswer
inline constexpr std::uint64_t kFeatureShapes = 262144;      // shapes in Welcome, and ShapesGiven
inline constexpr std::uint64_t kFeatureTextures = 1 << 20;   // TexturesGiven to TextureParts
inline constexpr std::uint64_t kFeatureWorldTime = 1 << 22;  // WorldTime
// SessionAccepted.place, and lines of the chat of the kind visit.
inline constexpr std::uint64_t kFeatureVisits = 1 << 24;
inline constexpr std::uint64_t kFeatureVoxelAuthors = 1 << 25;  // LogMarksRequest.at
// VeiledCommit and VeilPatches. No server offers it yet (docs/veil.md).
inline constexpr std::uint64_t kFeatureVeil = 1 << 26;
inline constexpr std::uint64_t kFeatureChatWithdrawal = 1 << 27;  // ChatWithdrawn
inline constexpr std::uint64_t kFeatureStrokes = 1 << 30;  // PreviewShare and PlayerPreview.stroke
// Only for a client that has the world's own key: another server of the same world.
inline constexpr std::uint64_t kFeatureServers = 2048;           // FollowRequest to RelayCharge
inline constexpr std::uint64_t kFeatureTimeCorrections = 16384;  // LogPart may have a CorrectTime
inline constexpr std::uint64_t kFeatureLibrary = 65536;          // LogPart may have a LibraryChange
inline constexpr std::uint64_t kFeatureShapeRecords = 524288;    // LogPart may have GivenShapes
inline constexpr std::uint64_t kFeatureTextureRecords = 1 << 21;  // LogPart may have a GivenTexture
inline constexpr std::uint64_t kFeatureClockRecords = 1 << 23;    // LogPart may have a ClockEdit
inline constexpr std::uint64_t kFeatureTimedGrants =
    1 << 28;  // LogPart may grant a role until a time
inline constexpr std::uint64_t kFeaturesOfServers =
    kFeatureServers | kFeatureTimeCorrections | kFeatureLibrary | kFeatureShapeRecords |
    kFeatureTextureRecords | kFeatureClockRecords | kFeatureTimedGrants;
// Those that a server offers to players.
inline constexpr std::uint64_t kFeaturesKnown =
    kFeatureCommands | kFeatureReceiveAck | kFeatureNames | kFeatureRights | kFeatureChat |
    kFeatureKeyTransfer | kFeatureMaterials | kFeatureLogMarks | kFeatureRestorePreview |
    kFeaturePreviews | kFeatureTiles | kFeatureResume | kFeatureServerList | kFeatureLargeActions |
    kFeatureBuilds | kFeatureShapes | kFeatureTextures | kFeatureWorldTime | kFeatureVisits |
    kFeatureVoxelAuthors | kFeatureChatWithdrawal | kFeatureStrokes;

// When a client acknowledges terrain: kReceiveAckEveryUs after the last acknowledgement or after
// kReceiveAckEveryBytes, whichever comes first, but never within kReceiveAckUsMin. That stays below
// the server's limit of messages a second.
inline constexpr std::int64_t kReceiveAckEveryUs = 10'000;
inline constexpr std::size_t kReceiveAckEveryBytes = 64 * 1024;
inline constexpr std::int64_t kReceiveAckUsMin = 1'000;

// Frames. A fragment is small, so that an edit never waits behind much terrain in a send buffer.
inline constexpr std::size_t kFrameHeaderBytes = 8;
inline constexpr std::size_t kFragmentBytesMax = 16 * 1024;

// Whole messages by class. They bound the memory that a peer can make us hold per session.
inline constexpr std::size_t kClientControlBytesMax = 4 * 1024;         // 256 claims
inline constexpr std::size_t kClientEditBytesMax = 64 * 1024;           // one descriptor
inline constexpr std::size_t kServerControlBytesMax = 8 * 1024 * 1024;  // the materials in Welcome
inline constexpr std::size_t kServerEditBytesMax = 1024 * 1024;         // one commit
inline constexpr std::size_t kServerChunkBytesMax = 16 * 1024 * 1024;   // one raw chunk

static_assert(kChunkBytesMax + 1024 <= kServerChunkBytesMax,
              "the largest raw chunk fits a message");

// FlatBuffers verifier: nesting and number of tables of the largest valid message.
inline constexpr unsigned kVerifierDepthMax = 8;
inline constexpr unsigned kVerifierTablesMax = 2 * kMaterialCountMax + 16;
static_assert(kMaterialCountMax * (kMaterialNameBytesMax + 40) + kTableShapesMax * kShapeBytesMax <=
                  kServerControlBytesMax,
              "a full material table fits Welcome, with its shapes");

// Handshake.
inline constexpr std::size_t kNonceBytes = 32;
inline constexpr std::size_t kSignatureBytes = 64;
inline constexpr std::size_t kTicketBytesMax = 128;
inline constexpr std::size_t kPasswordKeyBytes = 32;
inline constexpr std::size_t kWorldIdBytes = 16;
inline constexpr std::size_t kPlayerNameBytesMax = 32;
inline constexpr std::int64_t kHandshakeMsMax = 10'000;  // then a silent peer loses its slot

/// Bound of clock readings, in microseconds, in both directions. A reader can subtract any two of
/// them without an overflow.
inline constexpr std::int64_t kWireTimeUsMax = 1LL << 53;

// World.
inline constexpr std::size_t kViewRadiusMax = 64;     // chunks
inline constexpr std::uint16_t kViewConeMax = 32768;  // half a turn: the cone is the whole sphere

// Counts per message. They bound what a few bytes can unpack to, and the work of one request.
inline constexpr std::size_t kChunksPerMessageMax = 256;
inline constexpr std::size_t kRunsPerMessageMax = 65'536;  // of several chunks in one message
inline constexpr std::size_t kUniformChunksMax = 4096;
inline constexpr std::size_t kChunkRequestKeysMax = 64;
inline constexpr std::size_t kUnavailableKeysMax = 64;
inline constexpr std::size_t kCachedChunksMax = 256;
inline constexpr std::size_t kChunksNotModifiedMax = 1024;
inline constexpr std::size_t kChunkEditsMax = 1024;  // a server sends a snapshot instead of more
inline constexpr std::size_t kCommitEditsMax = 4096;
inline constexpr std::size_t kDigestCheckEntriesMax = 1024;
inline constexpr std::size_t kPlayersMax = 65536;
inline constexpr std::size_t kTextBytesMax = 256;  // of reject details and goodbye texts

inline constexpr std::size_t kTouchedChunksMax = 4096;       // per edit
inline constexpr std::size_t kVeilPatchesMax = 4096;         // per edit, and per VeilPatches
inline constexpr std::size_t kClaimsPerSessionMax = 32'768;  // claims that wait for an answer

// Rights.
inline constexpr std::size_t kGroundBoxesMax = 1024;    // that a session knows at a time
inline constexpr std::size_t kGroundNameBytesMax = 32;  // of boxes and roles
inline constexpr std::int32_t kGroundPriorityMax = 1000;

// Actions. Without the feature large actions, an action has so many edits at most.
inline constexpr std::size_t kActionEditsMax = 256;
// Edits that one session with large actions may have under way, that is sent and not answered, and
// the bytes of their descriptors. A server tells its bounds in Welcome. They pay for a round trip of
// 100 ms at 1,280 edits and 5 MB a second, and bound what waits at the server for the budgets.
inline constexpr std::uint32_t kWaitingEditsMax = 128;
inline constexpr std::uint32_t kWaitingEditBytesMax = 512 * 1024;
static_assert(kDescriptorBytesMax * 8 <= kWaitingEditBytesMax, "eight of the largest edits fit");

// Previews of others.
inline constexpr std::size_t kPreviewEditsMax = 4;         // of one player
inline constexpr std::size_t kPreviewBytesMax = 2 * 1024;  // of their descriptors together
inline constexpr std::uint64_t kPreviewChunksMax = 64;     // that an edit's bounds touch
inline constexpr std::uint32_t kPreviewTurnedVoxelsMax = 64 * 1024;  // of a paste that is turned
inline constexpr std::size_t kPreviewStrokeBytesMax = 1'856;
inline constexpr std::size_t kPreviewStrokePlacesMax = 256;
inline constexpr std::uint64_t kPreviewStrokeWorkMax = 6'000'000;  // of stroke_work()
inline constexpr std::uint8_t kBrushKindMax = 1, kTerrainModeMax = 6, kPathModeMax = 1;
inline constexpr std::uint8_t kFalloffMax = 3;
inline constexpr std::uint16_t kTerrainSizeMax = 128, kTerrainStrengthMax = 64, kPathSizeMax = 64;
inline constexpr std::uint32_t kBrushSeedMax = 9'999;
inline constexpr std::size_t kBrushTextBytesMax = 1'024;  // of a filter and of a mix

// Chat.
inline constexpr std::size_t kChatBytesMax = 512;      // one line
inline constexpr std::size_t kChatLinesMax = 64;       // per message
inline constexpr std::size_t kChatWithdrawnMax = 128;  // per message

// Keys for another device.
inline constexpr std::size_t kKeySlotBytes = 16;
inline constexpr std::size_t kSealedKeyBytesMax = 512;

// Marks of the log.
inline constexpr std::size_t kLogMarksMax = 128;  // per message
// The greatest cause of a mark: Cause::materials, the last one of version 2.
inline constexpr std::uint8_t kLogMarkCauseMax = 7;

// Previews of rollbacks.
inline constexpr std::size_t kPreviewIdBytesMax = 32;
inline constexpr std::size_t kRestorePreviewEditsMax = 512;
inline constexpr std::size_t kRestorePreviewBytesMax =
    256 * 1024;  // of their descriptors, together
static_assert(kDescriptorBytesMax <= kRestorePreviewBytesMax, "every descriptor fits a preview");

// Between servers.
inline constexpr std::size_t kLogPartRecordsMax = 4096;
inline constexpr std::size_t kLogPartRowsMax = 4096;  // players, and also names
inline constexpr std::size_t kFoldedNameBytesMax = 512;
inline constexpr std::size_t kRelaySessionsMax = 4096;  // that one message is for
/// Of the body of a relayed message; the rest is for the list of sessions.
inline constexpr std::size_t kRelayBodyBytesMax = kServerEditBytesMax - 64 * 1024;
static_assert(kRelaySessionsMax * 4 + 512 <= kServerEditBytesMax - kRelayBodyBytesMax);
/// Records in one LogPart take so many bytes at most, beyond a single one.
inline constexpr std::size_t kLogPartBytesMax = 256 * 1024;

// The library of builds.
inline constexpr std::size_t kListedBuildsMax = 50;             // per message
inline constexpr std::size_t kBuildPieceBytes = 64 * 1024;      // of a file that a client fetches
inline constexpr std::size_t kBuildUploadBytesMax = 32 * 1024;  // of a file, per message
static_assert(kBuildUploadBytesMax + 512 <= kClientEditBytesMax, "an upload fits a message");

// Textures.
inline constexpr std::size_t kTexturesGivenMax = 1024;        // per message
inline constexpr std::size_t kTexturesGivenUsesMax = 65'536;  // of all pictures of a message
inline constexpr std::size_t kTexturesWantedMax = 96;         // per message
inline constexpr std::size_t kTexturePartsBytesMax = 64 * 1024;
static_assert(kTexturesGivenMax * (sizeof(TextureHash) + 6) + kTexturesGivenUsesMax * 3 + 512 <=
                  kServerEditBytesMax,
              "the pictures of a message fit it");
static_assert(kTexturesWantedMax * sizeof(TextureHash) + 512 <= kClientControlBytesMax,
              "the hashes of a message fit it");
static_assert(sizeof(TextureHash) + 2 + kTextureBytesMax <= kTexturePartsBytesMax,
              "every picture fits a message");

// The list of servers.
inline constexpr std::size_t kServersMax = 64;
inline constexpr std::size_t kServerAddressBytesMax = 256;  // also of the address of a page

// Commands.
inline constexpr std::size_t kCommandBytesMax = 1024;      // one line
inline constexpr std::size_t kCommandLinesMax = 64;        // per output message
inline constexpr std::size_t kCommandLineBytesMax = 1024;  // per line of output
static_assert(kDescriptorBytesMax + 512 <= kClientEditBytesMax,
              "every descriptor fits a request, also one that a server passes on");

}  // namespace runstone
