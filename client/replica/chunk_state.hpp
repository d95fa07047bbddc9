// ChunkState: what the server has said about a chunk on this connection. The transitions are pure functions; ChunkTable
// performs them and counts.
//
//   expected ----request----> requested
//      | answer                  | answer
//      v                         v
//   current ----request----> repairing          take_snapshot: each --> current
//      ^ answer                                 withhold:      each --> unavailable
//   unavailable                                 expect:        each --> expected (another connection or moment)
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/assert.hpp"

namespace runstone {

enum class ChunkState : std::uint8_t {
  expected,  // The server has not answered. A copy from a cache or an earlier connection may be shown.
  requested,  // As expected, but a snapshot was requested. Nothing but a snapshot is applied.
  current,    // The server has vouched for the confirmed chunk. Commits are applied to it.
  repairing,  // As current, but commits got lost or the digest differs: a snapshot was requested, as above.
  unavailable,  // The server cannot send the chunk. Nothing is held, shown or held back.
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

/// A message arrived that carries the chunk or vouches for the copy that is held. A request stays open.
constexpr ChunkState after_answer(ChunkState state) {
  return is_awaiting(state) ? ChunkState::repairing : ChunkState::current;
}
/// A snapshot is requested. Requires a chunk that is not unavailable.
constexpr ChunkState after_request(ChunkState state) {
  RUNSTONE_ASSERT(state != ChunkState::unavailable);
  return is_vouched(state) ? ChunkState::repairing : ChunkState::requested;
}

}  // namespace runstone
