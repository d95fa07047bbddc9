// ChunkState: what the server has said about a chunk on this connection. The transitions are pure
// functions; ReplicaChunks performs them and counts.
//
//   expected --request--> requested      answer: requested --> repairing, the others --> current
//   current  --request--> repairing      set_current:     every state --> current
//                                        set_unavailable: every state --> unavailable
//                                        expect:          every state --> expected
//
// `expect` begins another connection, or another moment of the past.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/assert.hpp"

namespace runstone {

enum class ChunkState : std::uint8_t {
  /// The server has not answered. A copy from a cache or an earlier connection may be shown.
  /// Commits that continue its version are applied. A commit that does not follow waits in the
  /// inbox, and no snapshot is requested: the answer closes the gap.
  expected,
  /// The server has not answered, and a snapshot was requested. A copy from a cache or an earlier
  /// connection may be shown. Nothing but a snapshot is applied.
  requested,
  /// The server has vouched for the confirmed chunk. Commits are applied to it, and a gap makes it
  /// request a snapshot.
  current,
  /// The server has vouched for the confirmed chunk, but edits got lost or the digest differs, and a
  /// snapshot was requested. Nothing but a snapshot is applied.
  repairing,
  /// The server cannot send the chunk. Nothing is held, shown or held back.
  unavailable,
};
inline constexpr std::size_t kChunkStateCount = 5;

/// Returns true if the server has answered with the chunk on this connection.
constexpr bool is_vouched(ChunkState state) {
  return state == ChunkState::current || state == ChunkState::repairing;
}
/// Returns true if a snapshot was requested and has not arrived.
constexpr bool is_awaiting(ChunkState state) {
  return state == ChunkState::requested || state == ChunkState::repairing;
}

/// A message arrived that carries the chunk or vouches for the copy that is held. A request stays
/// open.
constexpr ChunkState after_answer(ChunkState state) {
  return is_awaiting(state) ? ChunkState::repairing : ChunkState::current;
}
/// A snapshot is requested. Requires a chunk that is not unavailable.
constexpr ChunkState after_request(ChunkState state) {
  RUNSTONE_ASSERT(state != ChunkState::unavailable);
  return is_vouched(state) ? ChunkState::repairing : ChunkState::requested;
}

}  // namespace runstone
