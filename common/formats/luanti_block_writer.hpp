// Writes blocks of Luanti's worlds: 16^3 voxels become the bytes of a row of map.sqlite. Format:
// Luanti's doc/world_format.md, serialisation version 28, which every Luanti since 5.0 reads.
#pragma once
#include <functional>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/formats/luanti_names.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns the node that a material becomes; "air" for an empty one. Names of more than 65,535
/// bytes are not allowed.
using LuantiNodeOf = std::function<LuantiNode(Material)>;

/// Returns the bytes of a block. Its nodes have full light of the day; it has no metadata, objects
/// or timers, and is marked as generated, so that Luanti's map generator leaves it alone. Requires
/// voxels of 16^3. decode_luanti_block() gives equal voxels. Cost: O(nodes).
Bytes encode_luanti_block(const RunChunk& voxels, const LuantiNodeOf& node_of);

}  // namespace runstone
