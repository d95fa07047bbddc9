// SharedGround: the ground of a fleet of headless bots, which keep no voxels. It has each chunk as
// it first arrived at any bot. Later edits do not show, so bots build on the ground as it was at
// the start. Bound: kGroundChunksMax chunks; further ones are dropped. One thread.
#pragma once
#include <cstddef>
#include <functional>
#include <map>

#include "client/bots/ground_height.hpp"
#include "common/core/coords.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

inline constexpr std::size_t kGroundChunksMax = 65'536;

class SharedGround final : public GroundHeight {
 public:
  /// Keeps the voxels unless the chunk is known. Requires chunks of one edge: 16, 32, 64 or 128.
  void add(ChunkCoord at, const RunChunk& voxels);
  /// Searches the known chunks of the column from the highest to the lowest. Cost: O(chunks of the
  /// column * edge * log runs).
  std::optional<std::int32_t> surface(std::int32_t x, std::int32_t z) const override;
  std::size_t chunks() const { return chunks_; }

 private:
  struct Column {
    std::int32_t x = 0, z = 0;
    friend auto operator<=>(const Column&, const Column&) = default;
  };
  std::map<Column, std::map<std::int32_t, RunChunk, std::greater<>>> columns_;  // highest first
  std::size_t chunks_ = 0;
  std::int32_t edge_ = 0;
};

}  // namespace runstone
