// SharedGround: the ground of a crowd of light bots, who keep no voxels of their own: each chunk as the first of them saw it. Later
// edits do not show, so who builds here builds on what stood at the start. Bound: kGroundChunksMax chunks; further ones are
// not kept. One thread.
#pragma once
#include <cstddef>
#include <functional>
#include <map>

#include "client/bots/ground.hpp"
#include "common/core/coords.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

inline constexpr std::size_t kGroundChunksMax = 65'536;

class SharedGround final : public Ground {
 public:
  /// Keeps the voxels unless the chunk is known. All chunks are of one edge, 16, 32, 64 or 128.
  void add(ChunkCoord at, const RunChunk& voxels);
  /// Looks from the highest chunk of the column that is known to the lowest. O(chunks of the column * edge * log runs).
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
