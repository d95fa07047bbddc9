// StoreCase: the input of every store of one volume: the same positions, edits and brushes, drawn
// from a seed.
#pragma once
#include <cstdint>
#include <vector>

#include "bench/storage/ball.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::bench::storage {

inline constexpr std::int32_t kBrushRadius = 5;  // voxels

struct PointEdit {
  LocalPos at;
  Material now, before;  // always different
};
struct Brush {
  Ball ball;
  Material material;
};

struct StoreCase {
  RunChunk chunk;
  std::vector<LocalPos> reads;
  std::vector<PointEdit> edits;
  std::vector<Brush> brushes;
  double brush_voxels = 0;  // of a brush, inside the chunk: mean
};

/// Returns the case of a chunk. Places are uniform in the chunk. Materials are drawn from those of
/// the chunk, the empty one, and one that the chunk does not have.
StoreCase make_store_case(const RunChunk& chunk, std::uint64_t seed);

}  // namespace runstone::bench::storage
