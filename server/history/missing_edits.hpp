// Missing edits: the edits that lead from an earlier version of a chunk to its newest, read from
// the log. They bring the copy that a client kept up to date. All functions block on the disk.
#pragma once
#include <cstddef>
#include <optional>

#include "common/runs/chunk.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

/// The number of edits of the whole world that a copy may be behind. A copy that is further behind
/// gets a snapshot.
inline constexpr Sequence kUpdateStretchMax = 1'000'000;
/// The number of edits near the chunk that are read before a snapshot counts as cheaper.
inline constexpr std::size_t kUpdateLooksMax = 4'096;

/// Returns the edits that lead from version `from` of the chunk to `chunk`. Requires that from.seq
/// < chunk.version.seq, and that the latter is durable. Returns nullopt if a snapshot is the better
/// answer:
///   - the edits take more than `bytes_max` bytes;
///   - there are more edits than the two bounds above allow;
///   - `from` is no version of this chunk in this log: its epoch was lost, or retention has removed
///     it.
StoreResult<std::optional<ChunkEdits>> missing_edits(LogReader& store, const ChunkKey& key,
                                                     const Chunk& chunk, const Version& from,
                                                     std::size_t bytes_max);

}  // namespace runstone
