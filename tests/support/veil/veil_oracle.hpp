// Veil oracle: finds the enclosed voxels of a chunk and the materials that they show, voxel by
// voxel on dense chunks. It shares no code with common/veil.
#pragma once
#include <array>
#include <functional>
#include <optional>

#include "common/core/coords.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/support/runs/dense_chunk.hpp"

namespace runstone::test {

/// A chunk and its neighbours, by Direction. All have the sides of the chunk.
struct DenseScene {
  DenseChunk chunk;
  std::array<std::optional<DenseChunk>, kDirectionCount> neighbours;

  /// Expands runs. A neighbour that is missing is null.
  static DenseScene of(const RunChunk& chunk,
                       const std::array<const RunChunk*, kDirectionCount>& neighbours);
};

/// The materials that cover, the filler, and the treatment of a missing neighbour.
struct VeilOracleRules {
  std::function<bool(Material)> covers;
  bool missing_covers = true;
  Material filler = 1;
};

/// Mistakes that the oracle makes on request, so that a test can show that it detects them.
enum class VeilFault { none, forgets_neighbours, hides_walls };

bool oracle_encloses(const DenseScene& scene, VoxelPos at, const VeilOracleRules& rules,
                     VeilFault fault = VeilFault::none);

/// Returns the veiled chunk by the rule in `order`.
DenseChunk oracle_veil(const DenseScene& scene, AxisOrder order, const VeilOracleRules& rules,
                       VeilFault fault = VeilFault::none);

}  // namespace runstone::test
