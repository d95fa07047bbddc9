// Keyframe: all chunks of one moment, kept so that the world of that moment is known without an
// edit before it.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/digest.hpp"
#include "common/core/ids.hpp"
#include "server/store/chunk_reader.hpp"
#include "server/store/log_reader.hpp"

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

}  // namespace runstone
