// A second implementation of the thesis' scenario models, voxel by voxel in the thesis' axes (z
// up), from the formulas of its data. It is the oracle of common/generate/scenarios and shares no
// code with it.
#pragma once
#include "tests/support/runs/dense_chunk.hpp"

namespace runstone::test {

/// Returns the model of scenario `number` (1 .. 37, not 5) at `edge`, solid voxels of material 1,
/// in our axes.
DenseChunk scenario_dense(unsigned number, unsigned edge);

/// Returns the smallest distance from zero of the sums that decide scenarios 14 to 16 at any edge
/// up to 128, where not every summand is exactly zero. Two maths libraries may differ by less than
/// this.
double smallest_wave_sum();

}  // namespace runstone::test
