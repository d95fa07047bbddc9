// Replayer: rebuilds a world from base and log alone and compares the result, digest by digest, with what was
// stored as snapshots and with what a server or clients wrote down. Snapshots are never read for their
// voxels. This is the proof that the log is the world: same apply function, another time, another process.
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

/// Two digests that should be equal and are not, or a version that the log does not have.
struct ReplayDifference {
  std::string source;  // "snapshot", "keyframe", "followed digest" or the name of a list
  ChunkKey key;
  Version expected_version,
      rebuilt_version;  // equal, unless the log never brought the chunk to the first
  Digest expected, rebuilt;
  std::string message() const;  // one line
};

struct ReplayReport {
  Sequence seq = 0;  // where the replay ended
  std::uint64_t edits = 0;
  /// Summed over sweeps: what one edit of a sweep sets and a later one resets is not in it.
  std::uint64_t voxels_changed = 0;
  StackDepths stack_depths;  // of the sweeps
  std::uint64_t snapshots_compared = 0;
  std::uint64_t keyframes_compared = 0;  // chunks of them
  std::uint64_t listed_compared = 0;
  std::uint64_t not_compared =
      0;  // snapshots and listed chunks newer than `seq`, or of another level of detail
  std::uint64_t differences = 0;
  std::optional<ReplayDifference> first;  // the first one met
  Digest world_digest;                    // over `digests`
  std::vector<DigestCheckEntry> digests;  // of all edited chunks, ascending
};

class Replayer {
 public:
  /// Both must outlive the replayer. The store may be open for reading only, with a server writing meanwhile.
  Replayer(WorldReader& store, const Generator& generator);

  /// Compares each listed chunk when (and if) the replay brings it to the listed version. Versions newer than
  /// the end of the replay are left out; versions that the log passed without meeting them are differences.
  void expect(const std::string& source, const DigestList& list);

  /// The same for chunks that keyframes hold.
  void expect_keyframes(const std::vector<StoredChunk>& chunks);

  /// Called now and then with the sequence reached and the last one.
  using Progress = std::function<void(Sequence, Sequence)>;
  /// Replays the edits of the log up to min(at, last). Call once. Memory: all edited chunks as runs. Fails
  /// with what the store says about rows that cannot be read, and (bad_request) if the log begins behind
  /// `at`.
  StoreResult<ReplayReport> run(Sequence at, const Progress& progress = {});

 private:
  struct Expected {
    std::string source;
    Version version;
    Digest digest;
  };

  StoreResult<void> replay_edit(const EditRecord& record);
  StoreResult<void> expect_snapshots();
  /// Compares with all that is expected of this chunk at its present version and forgets that.
  StoreResult<void> compare(const ChunkKey& key, ReplayedChunk& rebuilt);
  /// What was not met on the way: chunks that no edit touched, versions beyond the end, versions that never
  /// were.
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
  FollowScratch scratch_;
  ReplayReport report_;
};

}  // namespace runstone
