// Tile oracle: the rules of tiles and veils, voxel by voxel on dense chunks. It shares no code with
// common/tiles. Its functions count dense expansions.
#pragma once
#include <array>
#include <functional>

#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/support/runs/dense_chunk.hpp"

namespace runstone::test {

/// Child i lies at x = i & 1, y = i >> 1 & 1, z = i >> 2; null is empty.
using Children = std::array<const RunChunk*, 8>;

/// Returns the tile of children of `edge`.
DenseChunk expected_tile(const Children& children, unsigned edge, const MaterialTable& materials);

/// Returns the veiled chunk.
DenseChunk expected_veil(const DenseChunk& tile, AxisOrder order, const MaterialTable& materials);

/// Eight children of one extent, with pointers to them.
struct ChildChunks {
  std::array<RunChunk, 8> chunks;
  Children pointers() const;
};

/// Returns the children of `edge` whose voxels have the given materials, x, y and z in
/// [0, 2 * edge).
ChildChunks children_of(unsigned edge, AxisOrder order,
                        const std::function<Material(int x, int y, int z)>& material);

}  // namespace runstone::test
