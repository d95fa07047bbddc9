// Missing edits: what leads from an earlier version of a chunk to its newest, read from the log, for a client that kept
// the earlier one. Blocks on the disk.
#pragma once
#include <cstddef>
#include <optional>

#include "common/runs/chunk.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

/// Edits that a copy may be behind, anywhere in the world; a copy that is further behind gets a snapshot.
inline constexpr Sequence kUpdateStretchMax = 1'000'000;
/// Edits looked at, that come near the chunk, before a snapshot is thought cheaper.
inline constexpr std::size_t kUpdateLooksMax = 4'096;

/// The edits that lead from version `from` of the chunk to `chunk`. Nothing if a snapshot serves better: they take more
/// than `bytes_max` bytes, they are too many to look for, or `from` is no version of this chunk in this log (of a lost
/// epoch, or compacted away). Requires from.seq < chunk.version.seq, which is durable.
StoreResult<std::optional<ChunkEdits>> missing_edits(LogReader& store, const ChunkKey& key,
                                                     const Chunk& chunk, const Version& from,
                                                     std::size_t bytes_max);

}  // namespace runstone
