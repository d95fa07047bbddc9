// RestorePlan: what has to be written into one chunk so that the selected edits are taken back there
// (common/edits/restore/restore.hpp says what that means), as it follows from the log up to some sequence. A plan is
// made on a worker; whoever carries it out later sees by the version whether the chunk is still the one that
// the plan was made for.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/edits/apply/replayed_chunk.hpp"
#include "common/edits/restore/restore.hpp"
#include "common/generate/generator.hpp"
#include "server/rollback/chunk_logs.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct RestorePlan {
  ChunkKey key;
  Version version;           // of the chunk, up to the sequence that was asked for
  std::uint64_t edits = 0;   // selected ones in this chunk
  Sequence subject = 0;      // the newest of them
  std::uint64_t voxels = 0;  // that change
  // The chunk now and as it will be, in one axis order. Equal where nothing outside the box may change.
  RunChunk now, restored;
  std::vector<Difference> differences;  // between the two
};

class RestorePlanner {
 public:
  /// All must outlive the planner. One thread, which alone uses the reader.
  /// `kept_bytes_max`: as in ChunkLogs, for who plans a chunk several times.
  RestorePlanner(WorldReader& reader, const Generator& generator, GoesOn goes_on = {},
                 std::size_t kept_bytes_max = 0)
      : reader_(reader),
        generator_(generator),
        goes_on_(goes_on),
        logs_(reader, std::move(goes_on), kept_bytes_max) {}

  /// `selected`: edits that touch the chunk, ascending, at least one. `box`: voxels outside stay. Reads the log up
  /// to `end`, which must be durable. Fails with what the store says, and with cancelled. O(edits that touched the chunk since its newest stored form from before the
  /// first selected one).
  StoreResult<RestorePlan> plan(const ChunkKey& key, std::span<const Sequence> selected,
                                const std::optional<VoxelBox>& box, Sequence end);

 private:
  WorldReader& reader_;
  const Generator& generator_;
  GoesOn goes_on_;
  ChunkLogs logs_;
  FollowScratch scratch_;
};

}  // namespace runstone
