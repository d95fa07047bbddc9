// KeyframeReader: reading of keyframes. A keyframe keeps all chunks of one moment, so that the
// world of that moment is known without an edit before it.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/ids.hpp"
#include "common/runs/chunk.hpp"
#include "server/store/chunk_reader.hpp"
#include "server/store/log_reader.hpp"
#include "server/store/store_error.hpp"
#include "server/store/world_info.hpp"

namespace runstone {

struct Keyframe {
  LogEnd at;                 // the last edit that it contains
  std::uint64_t chunks = 0;  // number of chunks edited up to there
  Digest world_digest;       // over these chunks
  friend bool operator==(const Keyframe&, const Keyframe&) = default;
};

/// A moment that is known without edits: a keyframe, or the head of the log.
struct StoredMoment {
  LogEnd at;
  std::vector<StoredChunk> chunks;  // all chunks that were edited up to there, ascending by key
};

class KeyframeReader : public virtual WorldInfo {
 public:
  /// Returns all keyframes, ascending.
  virtual StoreResult<std::vector<Keyframe>> keyframes() = 0;
  /// Returns all chunks that keyframes hold, ascending by sequence.
  virtual StoreResult<std::vector<StoredChunk>> keyframe_chunks() = 0;
  /// Returns the newest stored moment at or before `at`, after a check of its digest. Fails
  /// (bad_request) if the log begins after `at`.
  virtual StoreResult<StoredMoment> stored_moment(Sequence at) = 0;
  /// Returns a chunk of a stored moment, or nullopt if a compaction has removed it since.
  virtual StoreResult<std::optional<Chunk>> load_stored(const StoredChunk& chunk) = 0;
  /// Returns the newest form of a chunk that keyframes hold at or before `at`, or nullopt if there
  /// is none. The keyframe it belongs to may be incomplete: the form is that of its version all the
  /// same. Cost: O(log rows).
  virtual StoreResult<std::optional<Chunk>> load_kept(const ChunkKey& key, Sequence at) = 0;
};

}  // namespace runstone
