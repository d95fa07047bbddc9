// UprightChunks: shown chunks with lines along y, as brushes read them, kept from one plan of a
// brush to the next. While the aim moves, most chunks of two plans are the same. Thread: one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

#include "common/runs/run_chunk.hpp"

namespace runstone {

class UprightChunks {
 public:
  /// The greatest number of runs of the chunks that are kept, in both orders: about 25 MB.
  static constexpr std::size_t kKeptRunsMax = std::size_t{1} << 22;

  explicit UprightChunks(std::size_t runs_max = kKeptRunsMax) : runs_max_(runs_max) {}

  /// Forgets the chunks that of() has not returned since the last call. Call it before each plan.
  void begin_plan();
  /// Returns the chunk with lines along y, or the chunk itself if it is uniform or has them
  /// already. A chunk whose runs have no room is not kept. Requires a chunk. Cost: that of
  /// reorder() for a chunk that is not kept, otherwise O(log chunks).
  std::shared_ptr<const RunChunk> of(const std::shared_ptr<const RunChunk>& chunk);
  /// Forgets all chunks.
  void clear() {
    kept_.clear();
    runs_ = 0;
  }
  std::size_t size() const { return kept_.size(); }

 private:
  struct Kept {
    std::size_t runs() const { return chunk->runs.size() + upright->runs.size(); }
    std::shared_ptr<const RunChunk> chunk;  // kept, so that no other chunk gets its address
    std::shared_ptr<const RunChunk> upright;
    std::uint64_t used = 0;
  };
  std::map<const RunChunk*, Kept> kept_;
  std::size_t runs_max_;
  std::size_t runs_ = 0;  // of kept_
  std::uint64_t plan_ = 0;
};

}  // namespace runstone
