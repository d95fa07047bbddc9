// WorldAt: the world as it was at a sequence. Opening one reads the edits behind the newest keyframe before it, not the
// chunks: a chunk is made when it is asked for, from what is stored of it there and the edits that touched it since, with
// the same apply_stack() as the server's.
// Memory: every edit read, once; for each chunk ever edited what is stored of it, without voxels, and the list of its edits.
// No chunk is kept. Threads: one, which alone uses the reader. A server may write the world meanwhile; a compaction that goes
// beyond the moment is noticed and reported.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/edits/apply/replayed_chunk.hpp"
#include "common/generate/generator.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

class WorldAt {
 public:
  /// Called now and then with the sequence read and the one to be reached. False ends the work with Kind::cancelled.
  using Progress = std::function<bool(Sequence, Sequence)>;

  /// Both must outlive the object. `at` 0 is the world before the first edit. Fails (bad_request) if `at` lies before what
  /// the log can still tell, naming where it begins, or behind its end, naming that.
  static StoreResult<WorldAt> open(WorldReader& reader, const Generator& generator, Sequence at,
                                   const Progress& progress = {});

  Sequence at() const { return end_.version.seq; }
  /// Version and time of the last edit at or before `at`; all 0 before the first.
  const LogEnd& end() const { return end_; }

  /// The chunk as it stood at `at`, in its cheapest axis order, with its digest. Its version is the last edit at or before
  /// `at` that touched it, (0, 0) if none did. Requires lod 0 and a chunk inside the world. O(its edits * its runs / 64).
  StoreResult<Chunk> chunk(const ChunkKey& key);
  /// The version that chunk() would carry, without making it.
  Version version(const ChunkKey& key) const;
  /// All chunks that edits touched up to `at`, ascending.
  std::vector<ChunkKey> edited() const;

  /// Goes on to a later sequence and reads only the edits between. Fails as open() does, also (bad_request) for an
  /// earlier one; the object then stays where it was.
  StoreResult<void> advance(Sequence at, const Progress& progress = {});

  /// The moment whose chunks are stored: no edit up to there was read. Its sequence is 0 in a world without keyframes.
  Sequence stored_at() const { return stored_at_; }
  /// Chunks that edits touched since the stored moment, ascending.
  std::vector<ChunkKey> touched() const;
  /// What a keyframe at `at` says of the chunks that were not.
  Keyframe untouched() const;

 private:
  /// What is known of a chunk that edits touched.
  struct Edited {
    std::optional<StoredChunk> stored;  // else its base was never edited before
    std::vector<std::uint32_t> edits;   // touched it since, as indices of edits_
  };

  WorldAt(WorldReader& reader, const Generator& generator)
      : reader_(&reader), generator_(&generator), edge_(reader.meta().chunk_edge) {}
  StoreResult<Chunk> start_of(const ChunkKey& key, const Edited* edited);
  Unexpected<StoreError> refuse(std::string what) const;

  WorldReader* reader_;
  const Generator* generator_;
  std::int32_t edge_;
  LogEnd end_;
  Sequence stored_at_ = 0;
  std::vector<EditDescriptor> edits_;
  std::vector<Version> versions_;  // of edits_
  std::map<ChunkKey, Edited> chunks_;
  FollowScratch scratch_;
};

}  // namespace runstone
