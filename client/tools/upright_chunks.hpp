// UprightChunks: shown chunks with lines along y, as brushes read them, kept from one plan of a brush to
// the next. While the aim moves, most chunks of two plans are the same. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

#include "common/runs/run_chunk.hpp"

namespace runstone {

class UprightChunks {
 public:
  /// The chunks that are kept, at most.
  static constexpr std::size_t kKeptMax = 1024;

  /// Forgets the chunks that of() has not returned since the last call. Call it before each plan.
  void begin_plan();
  /// Returns the chunk with lines along y, or the chunk itself if it is uniform or has them already.
  /// Requires a chunk. Cost: that of reorder() for a new chunk, otherwise O(log chunks).
  std::shared_ptr<const RunChunk> of(const std::shared_ptr<const RunChunk>& chunk);
  std::size_t size() const { return kept_.size(); }

 private:
  struct Kept {
    std::shared_ptr<const RunChunk> chunk;  // so that no other chunk gets its address
    std::shared_ptr<const RunChunk> upright;
    std::uint64_t used = 0;
  };
  std::map<const RunChunk*, Kept> kept_;
  std::uint64_t plan_ = 0;
};

}  // namespace runstone
