// StopReport: what a server leaves behind, summed up from what it held in memory when it stopped and what is
// on disk. Both must tell the same world.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "server/replay/digest_list.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct StopReport {
  bool is_clean = false;  // everything ordered is on disk, in the log and in snapshots
  Digest world_digest;    // over `digests`; of the world at their seq only if the stop was clean
  /// After a clean stop all chunks ever edited: what was in memory recomputed from its runs there, the rest
  /// from its snapshot. After any other stop only what is on disk, the snapshots, each as it stands there:
  /// what was in memory may contain edits that are lost.
  DigestList digests;
  std::size_t live_chunks = 0;  // edited chunks that were in memory
  std::string error;  // first row that cannot be read or is not what was in memory; empty if none
};

/// The line a program prints last: "stopped seq=… edited_chunks=… live=… world_digest=…", or "stopped unclean
/// seq=… snapshots=… live=…", without a digest, for there is no sequence whose it would be.
std::string stop_line(const StopReport& report);

/// `live`: the edited chunks that were in memory, ascending. After a clean stop each has an equal snapshot;
/// any other stop leaves chunks that are newer than theirs. Reads every snapshot.
StopReport sum_up(WorldReader& store, std::span<const std::pair<ChunkKey, ChunkPtr>> live,
                  bool is_clean);

}  // namespace runstone
