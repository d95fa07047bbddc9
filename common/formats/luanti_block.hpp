// Luanti map blocks: 16^3 nodes of another program's world, bytes in, runs out. The SQLite side of a foreign
// world lives in server/. Format: Luanti's doc/world_format.md, serialisation version 29 (28 and older are zlib
// streams and are refused by name).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

inline constexpr std::int32_t kLuantiBlockEdge = 16;

struct LuantiBlock {
  RunChunk voxels;                 // 16^3, order xzy... whatever the block's own node order is; materials are
                                   // indices into `names` + 1, so that 0 stays "not there"
  std::vector<std::string> names;  // node names of this block, e.g. "default:stone"
};

/// Block coordinate of a row's `pos`.
ChunkCoord luanti_block_coord(std::int64_t pos);

/// One block's `data`. Every byte is hostile: lengths, counts, ids and the zstd stream are bounded.
Result<LuantiBlock> decode_luanti_block(ByteView data);

/// How a node name becomes a material: colour and visibility by name and kind (water and glass transparent;
/// plants, torches and the like empty unless keep_all; "air" and "ignore" are empty). Deterministic.
MaterialInfo material_of_luanti_node(const std::string& name, bool keep_all);

}  // namespace runstone
