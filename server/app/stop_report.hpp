// StopReport: the state of the world after a stop, from the chunks that were in memory and from the
// disk. After a clean stop both must agree.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include "server/replay/digest_list.hpp"
#include "server/runtime/stop_state.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct StopReport {
  StopState state;
  bool is_clean = false;    // every ordered edit is in the log and in snapshots
  bool hands_over = false;  // another server takes the world over
  bool is_summed = true;  // the time was enough to read every snapshot; if not, `digests` is empty
  Digest world_digest;    // of `digests`; it is the world's digest only if the stop was clean
  /// After a clean stop, the list has all chunks ever edited: those in memory recomputed from their
  /// runs, the others from their snapshots. After any other stop it has the snapshots only, because
  /// chunks in memory may contain edits that are lost.
  DigestList digests;
  std::size_t live_chunks = 0;  // edited chunks that were in memory
  std::string error;  // the first row that cannot be read or differs from memory; empty: none
};

/// Returns the last line of the program:
///   - "stopped seq=… edited_chunks=… live=… world_digest=…" after a clean stop;
///   - "stopped seq=… chunks_left=… live=…" if every edit is in the log, but there was no time for
///     all snapshots or for the digest;
///   - "stopped unclean seq=… snapshots=… live=… lost_edits=…" otherwise.
/// Only the first one has a digest, because the snapshots do not belong to one sequence number.
std::string stop_line(const StopReport& report);

/// Makes the report. `live` are the edited chunks that were in memory, ascending. After a clean
/// stop each must have an equal snapshot; after any other stop they may be newer. Cost: reads every
/// snapshot, as long as `should_continue` returns true.
StopReport sum_up(WorldReader& store, std::span<const std::pair<ChunkKey, ChunkPtr>> live,
                  const StopState& state, const std::function<bool()>& should_continue);

}  // namespace runstone
