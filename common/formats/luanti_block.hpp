// Luanti map blocks: decodes 16^3 nodes of another program's world from bytes to runs. The SQLite
// side of such a world is in server/import. Format: Luanti's doc/world_format.md, serialisation
// versions 24 to 29.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

inline constexpr std::int32_t kLuantiBlockEdge = 16;
/// The maximum size of the names of a block, and of what is decompressed of a zstd stream. The
/// nodes are 16 KiB. What lies behind, the contents of chests and signs, may have any size.
inline constexpr std::size_t kLuantiBlockBytesMax = std::size_t{1} << 20;

/// Converts a row's `pos` to a block coordinate, and back. Block coordinates are -2048 .. 2047.
ChunkCoord luanti_block_coord(std::int64_t pos);
std::int64_t luanti_block_pos(ChunkCoord block);

/// Decodes one block's `data` to one piece of 16^3 voxels. The blocks of the piece are the names of
/// the block's own table in its order, at most 4096, and then each name with a state "param2=N" of
/// which N is not 0. Nodes `ignore`, which the other program has not generated, have material 0.
/// Every byte is untrusted: lengths, counts, ids and streams are bounded. Metadata, objects and
/// timers are ignored, and so are bytes behind the last stream, as in Luanti. Of a zstd stream the
/// first kLuantiBlockBytesMax bytes must decompress. The offset of an error is a byte of the
/// decompressed nodes, or of `data` if the stream itself is bad. Cost: O(nodes + decompressed
/// bytes).
Result<ForeignPiece> decode_luanti_block(ByteView data);
/// Gives the piece of decode_luanti_block() to the sink: the reader of Format.
Result<ForeignInfo> read_luanti_block(ByteView data, const PieceSink& sink);

/// Returns a material for a node: colour and visibility by name and kind, whatever its state. Water
/// and glass are transparent. Nodes that are no cubes have the shapes of their names; those without
/// one, such as wires, are empty unless keep_all. "air" and "ignore" are empty. A node that
/// luanti_node_name() has named, and any other without the name of a mod, is a cube with the name
/// of its material. The result is deterministic, and MaterialTable::add() accepts it for every
/// name. Only "air" and "ignore" share a row: that of air.
MaterialInfo material_of_luanti_node(const ForeignBlock& node, bool keep_all);

/// Returns the material of a node in a world of cubes: stairs and the like are whole cubes, plants
/// and the like are empty unless keep_all, and the name has no states.
MaterialInfo material_of_luanti_cube(const ForeignBlock& node, bool keep_all);

/// Returns true if the param2 of a node of this name gives it a direction, a shape or a colour. It
/// is false for flowing liquids (the level of the liquid), leaves (players placed them) and the
/// ground of plants under water (the height of the plant). docs/formats.md explains the rule.
bool keeps_luanti_param2(std::string_view name);

/// Returns material_of_luanti_node() for a node of a world. The name has the states as
/// world_name_of() has them, "default:chest[param2=3]", if keeps_luanti_param2().
MaterialInfo material_of_luanti_world_node(const ForeignBlock& node, bool keep_all);

}  // namespace runstone
