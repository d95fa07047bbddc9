// ground_rebuild: the chunks of a repaired world. Base and log give their voxels. A snapshot of the
// damaged world may show edits that the log lacks. Then the present voxels of the chunk are those
// of the snapshot with the later edits, and an edit of the server at the end of the log writes
// them. So players find such a chunk as they left it.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/edits/apply/replayed_chunk.hpp"
#include "common/generate/generator.hpp"
#include "server/repair/repair_report.hpp"
#include "server/store/store.hpp"

namespace runstone {

class GroundRebuild {
 public:
  /// The store has the snapshots of the damaged world. Both must outlive the object, except that
  /// the store may be closed after read().
  GroundRebuild(Store& store, const Generator& generator);

  /// Replays the log, and compares each chunk with its snapshot on the way. Memory: all edited
  /// chunks as runs.
  StoreResult<void> read(const std::function<void(Sequence, Sequence)>& on_progress);
  /// Returns the edits that write what the snapshots show and the log lacks, and lists the chunks.
  std::vector<EditDescriptor> missing_edits(std::vector<KeptGround>& ground);
  /// Follows these records, which were appended to the log.
  void follow(const std::vector<EditRecord>& records);
  /// Writes the snapshots of all edited chunks into a world that has none, and moves its checkpoint
  /// to the end of the log.
  StoreResult<void> save(Store& store);

 private:
  StoreResult<ReplayedChunk*> chunk_of(const ChunkKey& key);
  /// Compares the chunk with its snapshot.
  StoreResult<void> compare(const ChunkKey& key);
  void add(const EditRecord& record, const ChunkKey& key);

  Store& store_;
  const Generator& generator_;
  const std::int32_t edge_;
  std::map<ChunkKey, ReplayedChunk> chunks_;
  std::map<ChunkKey, ReplayedChunk> shown_;  // by a snapshot, where it differs, and by later edits
  ReplayScratch scratch_;
};

/// Deletes all snapshots of the world in a folder, which nobody has open.
StoreResult<void> forget_snapshots(const std::string& folder);

}  // namespace runstone
