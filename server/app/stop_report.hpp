// StopReport: the state of the world after a stop, from the chunks that were in memory and from the
// disk. Both must agree.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "server/replay/digest_list.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct StopReport {
  bool is_clean = false;  // every ordered edit is on disk, in the log and in snapshots
  Digest world_digest;    // of `digests`; it is the world's digest only if the stop was clean
  /// After a clean stop, the list has all chunks ever edited: those in memory recomputed from their
  /// runs, the others from their snapshots. After any other stop it has the snapshots only, because
  /// chunks in memory may contain edits that are lost.
  DigestList digests;
  std::size_t live_chunks = 0;  // edited chunks that were in memory
  std::string error;  // the first row that cannot be read or differs from memory; empty: none
};

/// Returns the last line of the program: "stopped seq=… edited_chunks=… live=… world_digest=…", or
/// "stopped unclean seq=… snapshots=… live=…". The latter has no digest, because the snapshots do
/// not belong to one sequence number.
std::string stop_line(const StopReport& report);

/// Makes the report. `live` are the edited chunks that were in memory, ascending. After a clean
/// stop each must have an equal snapshot; after any other stop they may be newer. Cost: reads every
/// snapshot.
StopReport sum_up(WorldReader& store, std::span<const std::pair<ChunkKey, ChunkPtr>> live,
                  bool is_clean);

}  // namespace runstone
