// Every limit of the wire in one place: decoder, verifier and queues take them from here.
// Each one says which attack or mistake it answers.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/extent.hpp"

namespace runstone {

inline constexpr std::uint32_t kProtocolVersion = 2;
/// Optional parts of the protocol that this build knows, a bit each.
inline constexpr std::uint64_t kFeatureCommands = 1;  // command_request and command_output
inline constexpr std::uint64_t kFeatureReceived =
    2;  // received: terrain is paced by what the client has read
inline constexpr std::uint64_t kFeaturesKnown = kFeatureCommands | kFeatureReceived;

// How often a client says what it has read: when it is due by time or by bytes, whichever comes first, and never
// more often than a server with its limits of messages can stand.
inline constexpr std::int64_t kReceivedEveryUs = 10'000;
inline constexpr std::size_t kReceivedEveryBytes = 64 * 1024;
inline constexpr std::int64_t kReceivedUsMin = 1'000;

// Frames. A fragment is small, so that an edit never waits behind much terrain in a send buffer.
inline constexpr std::size_t kFrameHeaderBytes = 12;
inline constexpr std::size_t kFragmentBytesMax = 16 * 1024;

// Whole messages, by what their class may carry: bounds the memory a peer can make us hold per session.
inline constexpr std::size_t kClientControlBytesMax = 4 * 1024;  // hello, view, ping: all small
inline constexpr std::size_t kClientEditBytesMax = 64 * 1024;    // one descriptor
inline constexpr std::size_t kServerControlBytesMax =
    8 * 1024 * 1024;                                             // the material table in welcome
inline constexpr std::size_t kServerEditBytesMax = 1024 * 1024;  // one commit
inline constexpr std::size_t kServerChunkBytesMax = 16 * 1024 * 1024;

// Chunk bytes. Raw noise at 128^3 is the worst case.
inline constexpr std::size_t kChunkHeaderBytes = 12;
inline constexpr std::size_t kChunkBytesMax = kChunkHeaderBytes + 6ULL * kVolumeMax;
static_assert(kChunkBytesMax + 1024 <= kServerChunkBytesMax,
              "the largest raw chunk fits a message");

// FlatBuffers verifier: nesting and table count of the largest honest message.
inline constexpr unsigned kVerifierDepthMax = 8;
inline constexpr unsigned kVerifierTablesMax = 2 * kMaterialCountMax + 16;
static_assert(kMaterialCountMax * (kMaterialNameBytesMax + 32) <= kServerControlBytesMax,
              "a full table fits welcome");

// Handshake.
inline constexpr std::size_t kKeyBytes = 32;
inline constexpr std::size_t kNonceBytes = 32;
inline constexpr std::size_t kSignatureBytes = 64;
inline constexpr std::size_t kWorldIdBytes = 16;
inline constexpr std::size_t kPlayerNameBytesMax = 32;
inline constexpr std::int64_t kHandshakeMsMax = 10'000;  // a peer that stays silent frees its slot

/// Clock readings, microseconds either way: a difference of two of them cannot overflow at any reader.
inline constexpr std::int64_t kWireTimeUsMax = 1LL << 53;

// World.
inline constexpr std::uint8_t kLodMax = 0;            // levels above full detail are reserved
inline constexpr std::size_t kViewRadiusMax = 64;     // chunks
inline constexpr std::uint16_t kViewConeMax = 32768;  // half a turn: all around
inline constexpr std::size_t kUniformChunksMax =
    4096;  // per message: bounds what a few bytes may unpack to
inline constexpr std::size_t kChunkRequestKeysMax = 64;  // per message
inline constexpr std::size_t kUnavailableKeysMax = 64;   // per message
inline constexpr std::size_t kHeldChunksMax = 256;       // per message
inline constexpr std::size_t kHeldClaimsMax = 32'768;    // that wait for an answer, per session
inline constexpr std::size_t kSameChunksMax = 1024;      // per message
inline constexpr std::size_t kChunkEditsMax =
    1024;  // per message; more of them are sent as a snapshot
inline constexpr std::size_t kCommitEditsMax = 4096;
inline constexpr std::size_t kTouchedChunksMax = 4096;  // per edit: bounds the work of one request
inline constexpr std::size_t kAuditEntriesMax = 1024;
inline constexpr std::size_t kPlayersMax = 65536;
inline constexpr std::size_t kTextBytesMax = 256;  // reject detail, goodbye text

// Commands.
inline constexpr std::size_t kCommandBytesMax = 1024;      // one line
inline constexpr std::size_t kCommandLinesMax = 64;        // of one output message
inline constexpr std::size_t kCommandLineBytesMax = 1024;  // each
static_assert(kDescriptorBytesMax + 256 <= kClientEditBytesMax, "every descriptor fits a request");

}  // namespace runstone
