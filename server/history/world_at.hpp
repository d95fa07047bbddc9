// WorldAt: the world as it was at a sequence. open() reads the edits after the newest keyframe
// before it, and no chunks. A chunk is made on request: from its stored form at the keyframe and
// the edits that touched it since, with the same apply_stack() as the server's.
// Memory: every edit read, once; for each chunk ever edited its stored form without voxels, and the
// list of its edits. No chunk is kept.
// Threads: one, which alone uses the reader, except for voxels(). A server may write the world
// meanwhile. If retention moves the beginning of the log past the edits that the object needs, this
// is detected and reported.
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
  /// A function that long calls use from time to time to report the sequence that was read and the
  /// last one to be read. If it returns false, the call fails with Kind::cancelled.
  using Progress = std::function<bool(Sequence, Sequence)>;
  /// A Progress is called once for this many edits.
  static constexpr Sequence kProgressEdits = 1024;

  /// Opens the world after edit `at`; 0 means before the first edit. Reader and generator must
  /// outlive the object. Fails (bad_request) if `at` was removed or lies after the end of
  /// the log. The error names the beginning or the end.
  static StoreResult<WorldAt> open(WorldReader& reader, const Generator& generator, Sequence at,
                                   const Progress& progress = {});

  Sequence at() const { return end_.version.seq; }
  /// Returns version and time of the last edit at or before at(). They are 0 before the first edit.
  const LogEnd& end() const { return end_; }

  /// Returns the chunk as it was, in its cheapest axis order, with its digest. Its version is that
  /// of the last edit at or before at() that touched it, or (0, 0) if none did. Requires lod 0 and
  /// a chunk inside the world. Cost: O(edits of the chunk * its runs / 64).
  StoreResult<Chunk> chunk(const ChunkKey& key);
  /// Returns the same voxels in any axis order, which is cheaper, without digest and version. Reads
  /// with another reader of the same world. Thread: any, each with a reader and a scratch of its
  /// own, while no function that is not const runs.
  StoreResult<RunChunk> voxels(const ChunkKey& key, WorldReader& reader,
                               ReplayScratch& scratch) const;
  /// Returns the version that chunk() would have, without making the chunk.
  Version version(const ChunkKey& key) const;
  /// Returns all chunks that edits touched up to at(), ascending.
  std::vector<ChunkKey> edited() const;

  /// Moves to a later sequence. Reads only the edits between. Fails as open(), and (bad_request)
  /// for an earlier sequence. After a failure the object is unchanged. `each` is called for every
  /// record that is read, also if the call fails later.
  StoreResult<void> advance(Sequence at, const Progress& progress = {},
                            const std::function<void(const EditRecord&)>& each = {});

  /// Returns the sequence of the stored moment that open() began with. It is 0 in a world without
  /// keyframes.
  Sequence stored_at() const { return stored_at_; }
  /// Returns the chunks that edits touched since the stored moment, ascending.
  std::vector<ChunkKey> touched() const;
  /// Returns the part of a keyframe at at() that covers the other chunks: those not in touched().
  Keyframe untouched() const;

 private:
  /// A chunk that edits touched.
  struct Edited {
    std::optional<StoredChunk> stored;  // nullopt: it has only its base, at version (0, 0)
    std::vector<std::uint32_t> edits;   // that touched it since, as indices of edits_
  };

  WorldAt(WorldReader& reader, const Generator& generator)
      : reader_(&reader), generator_(&generator), edge_(reader.meta().chunk_edge) {}
  /// Returns the chunk at the stored moment, in any axis order.
  StoreResult<Chunk> start_of(const ChunkKey& key, const Edited* edited, WorldReader& reader) const;
  /// Returns the chunk as chunk(), in any axis order.
  StoreResult<Chunk> replayed(const ChunkKey& key, WorldReader& reader,
                              ReplayScratch& scratch) const;
  Unexpected<StoreError> refuse(std::string what) const;

  WorldReader* reader_;
  const Generator* generator_;
  std::int32_t edge_;
  LogEnd end_;
  Sequence stored_at_ = 0;
  std::vector<EditDescriptor> edits_;
  std::vector<Version> versions_;  // of edits_
  std::map<ChunkKey, Edited> chunks_;
  ReplayScratch scratch_;
};

}  // namespace runstone
