// Replayer: rebuilds a world from base and log alone. It compares the digests of the result with
// those of the stored snapshots and with digests that a server or clients wrote. It never reads the
// voxels of a snapshot. It uses the same apply function as the server, in another process, so it
// proves that the log holds the world.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/edits/apply/replayed_chunk.hpp"
#include "common/generate/generator.hpp"
#include "server/replay/digest_list.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

/// Two digests that should be equal and differ, or a version that the log does not have.
struct ReplayDifference {
  std::string source;  // "snapshot", "keyframe", "followed digest" or the name of a list
  ChunkKey key;
  /// They are equal unless the log never brought the chunk to the expected version.
  Version expected_version, rebuilt_version;
  Digest expected, rebuilt;
  std::string message() const;  // one line
};

struct ReplayReport {
  Sequence seq = 0;  // where the replay ended
  std::uint64_t edits = 0;
  /// Summed over sweeps. A voxel that one edit of a sweep sets and a later one resets does not
  /// count.
  std::uint64_t voxels_changed = 0;
  StackDepths stack_depths;  // of the sweeps
  std::uint64_t snapshots_compared = 0;
  std::uint64_t keyframes_compared = 0;  // chunks of them
  std::uint64_t listed_compared = 0;
  /// Snapshots and listed chunks that are newer than `seq` or of another level of detail.
  std::uint64_t not_compared = 0;
  std::uint64_t differences = 0;
  std::optional<ReplayDifference> first;  // in the order of the replay
  Digest world_digest;                    // over `digests`
  std::vector<DigestCheckEntry> digests;  // of all edited chunks, ascending
};

class Replayer {
 public:
  /// Store and generator must outlive the replayer. The store may be open for reading only while a
  /// server writes it.
  Replayer(WorldReader& store, const Generator& generator);

  /// Adds the chunks of a list. Each is compared when the replay brings it to the listed version. A
  /// version that is newer than the end of the replay is not compared. A version that the log never
  /// gives to the chunk is a difference.
  void expect(const std::string& source, const DigestList& list);

  /// Adds the chunks of keyframes, as expect() those of a list.
  void expect_keyframes(const std::vector<StoredChunk>& chunks);

  /// A function that run() calls every 1024 edits with the sequence number reached and the last
  /// one.
  using Progress = std::function<void(Sequence, Sequence)>;
  /// Replays the edits of the log up to min(at, last). Call it once. Memory: all edited chunks as
  /// runs. Fails with the store's error if a row cannot be read, and with bad_request if the log
  /// begins after `at`.
  StoreResult<ReplayReport> run(Sequence at, const Progress& progress = {});

 private:
  struct Expected {
    std::string source;
    Version version;
    Digest digest;
  };

  StoreResult<void> replay_edit(const EditRecord& record);
  StoreResult<void> expect_snapshots();
  /// Compares the chunk with everything that is expected of it at its present version, and removes
  /// these expectations.
  StoreResult<void> compare(const ChunkKey& key, ReplayedChunk& rebuilt);
  /// Compares the remaining expectations: chunks that no edit touched, versions beyond the end, and
  /// versions that never existed.
  StoreResult<void> compare_rest();
  StoreResult<void> compare_left_over(const ChunkKey& key, const Expected& expected);
  void check(const ChunkKey& key, const Expected& expected, const Chunk& rebuilt);
  void count(const Expected& expected);
  void differs(ReplayDifference difference);

  WorldReader& store_;
  const Generator& generator_;
  const std::int32_t edge_;
  std::map<ChunkKey, ReplayedChunk> chunks_;
  std::map<ChunkKey, std::multimap<Version, Expected>> listed_;
  std::map<ChunkKey, Version> snapshots_;
  Sequence head_ = 0;  // up to which edits were moved from the log into the base
  ReplayScratch scratch_;
  ReplayReport report_;
};

}  // namespace runstone
