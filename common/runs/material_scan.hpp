// Material scan: questions about the materials of a chunk.
#pragma once
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns true if a voxel of the chunk has a material with this number or a greater one. Thread:
/// any.
/// Cost: O(runs).
bool has_material_from(const RunChunk& chunk, Material first);

}  // namespace runstone
