// Luanti map blocks: 16^3 nodes of another program's world, bytes in, runs out. The SQLite side of a foreign
// world lives in server/. Format: Luanti's doc/world_format.md, serialisation version 29 (28 and older are
// zlib streams and are refused by name).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

inline constexpr std::int32_t kLuantiBlockEdge = 16;
/// Bound of one block's decompressed bytes: 16 KiB of nodes plus what chests and signs hold.
inline constexpr std::size_t kLuantiBlockBytesMax = std::size_t{1} << 20;

struct LuantiBlock {
  RunChunk voxels;  // 16^3 in AxisOrder::xyz, the node order of the format. Material i + 1 is
                    // names[i]; 0 is an `ignore` node: the foreign world has not generated it
  std::vector<std::string>
      names;  // node names in the block's own order, e.g. "default:stone", at most 4096
};

/// Block coordinate of a row's `pos`, and back. Block coordinates are -2048 .. 2047.
ChunkCoord luanti_block_coord(std::int64_t pos);
std::int64_t luanti_block_pos(ChunkCoord block);

/// One block's `data`. Every byte is hostile: lengths, counts, ids and the zstd stream are bounded. What
/// follows the nodes (metadata, objects, timers) must decompress and is not looked at. The error's offset is
/// a byte of the decompressed stream, or of `data` where the stream itself is bad. O(nodes + decompressed
/// bytes).
Result<LuantiBlock> decode_luanti_block(ByteView data);

/// How a node name becomes a material: colour and visibility by name and kind (water and glass transparent;
/// plants, torches and the like empty unless keep_all; "air" and "ignore" are empty). Deterministic; the
/// result is a row that MaterialTable::add() accepts for every name. Only "air" and "ignore" share a row:
/// air's.
MaterialInfo material_of_luanti_node(std::string_view name, bool keep_all);

}  // namespace runstone
