// RestorePlan: the changes of one chunk that take the selected edits back there, computed from the
// log up to some sequence. common/edits/restore/restore.hpp defines the effect. A worker makes the
// plan. The version of the plan tells later whether it still fits the chunk.
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
  Version version;           // of the chunk at the sequence `end` of plan()
  std::uint64_t edits = 0;   // selected edits in this chunk
  Sequence subject = 0;      // the newest selected edit
  std::uint64_t voxels = 0;  // that change
  // The chunk before and after, in one axis order. Both are equal outside the box of plan().
  RunChunk now, restored;
  std::vector<Difference> differences;  // between `now` and `restored`
};

class RestorePlanner {
 public:
  /// Reader and generator must outlive the planner. `kept_bytes_max` is that of ChunkLogs: it pays
  /// for a caller that plans a chunk several times. Threads: one, which alone uses the reader.
  RestorePlanner(WorldReader& reader, const Generator& generator,
                 ShouldContinue should_continue = {}, std::size_t kept_bytes_max = 0)
      : reader_(reader),
        generator_(generator),
        should_continue_(should_continue),
        logs_(reader, std::move(should_continue), kept_bytes_max) {}

  /// Plans one chunk. `selected` are edits that touch it, ascending, at least one. Voxels outside
  /// `box` stay. Reads the log up to `end`. Requires that `end` is durable. Fails as the reader,
  /// and with cancelled. Cost: O(edits that touched the chunk since its newest stored form before
  /// the first selected edit).
  StoreResult<RestorePlan> plan(const ChunkKey& key, std::span<const Sequence> selected,
                                const std::optional<VoxelBox>& box, Sequence end);

  /// A chunk and the selected edits that touch it, ascending, at least one.
  struct Item {
    ChunkKey key;
    std::span<const Sequence> selected;
  };
  /// Is called with the plan of a chunk, or with why it could not be made. Returns false to end.
  using EachPlan = std::function<bool(const ChunkKey& key, StoreResult<RestorePlan> plan)>;
  /// Plans chunks as plan() does, in their order, and reads the log for many of them at once. Cost:
  /// that of plan() for each, but edits that lie scattered are read once for kBatchChunks chunks.
  void plan_all(std::span<const Item> items, const std::optional<VoxelBox>& box, Sequence end,
                const EachPlan& each);

  /// Is called with the number of voxels that the plan of a chunk changes, or with why it could not
  /// be made. Returns false to end.
  using EachCount = std::function<bool(const ChunkKey& key, StoreResult<std::uint64_t> voxels)>;
  /// Counts what plan_all() would change. Cost: where few voxels are selected in a chunk, only that
  /// of these voxels and of the edits that touched the chunk; elsewhere that of plan_all().
  void count_all(std::span<const Item> items, const std::optional<VoxelBox>& box, Sequence end,
                 const EachCount& each);

 private:
  /// The chunks whose log is read at once. Their stored forms are in memory meanwhile.
  static constexpr std::size_t kBatchChunks = 2'048;
  using StoredForm = std::optional<Chunk>;  // nullopt: the generator makes the chunk
  /// Reads the log of many chunks at once, and then calls `each` for each of them, in their order,
  /// with its stored form or with why that could not be read. Ends if `each` returns false.
  void in_batches(std::span<const Item> items, Sequence end,
                  const std::function<bool(const Item&, StoreResult<StoredForm>)>& each);
  /// Calls `each` for one chunk whose log does not fit into memory. `each` reads the log as it was
  /// when the stored form was read, because retention moves edits from one to the other.
  bool one_at_one_moment(const Item& item,
                         const std::function<bool(const Item&, StoreResult<StoredForm>)>& each);
  StoreResult<RestorePlan> plan_from(StoredForm stored, const Item& item,
                                     const std::optional<VoxelBox>& box, Sequence end);
  StoreResult<std::uint64_t> count_from(StoredForm stored, const Item& item,
                                        const std::optional<VoxelBox>& box, Sequence end);

  WorldReader& reader_;
  const Generator& generator_;
  ShouldContinue should_continue_;
  ChunkLogs logs_;
  ReplayScratch scratch_;
};

}  // namespace runstone
