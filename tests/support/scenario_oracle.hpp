// The thesis' scenario models a second time, voxel by voxel in the thesis' own axes (z up), from the formulas
// of its data: what common/generate/scenarios is held to. Shares no code with it.
#pragma once
#include "tests/support/dense_chunk.hpp"

namespace runstone::test {

/// The model of scenario `number` (1 .. 37, not 5) at `edge`, solid voxels of material 1, in our axes.
DenseChunk scenario_dense(unsigned number, unsigned edge);

/// The smallest distance from zero of the sums that decide scenarios 14 to 16 at any edge up to 128, where
/// not every summand is exactly zero: how far two maths libraries may differ.
double smallest_wave_sum();

}  // namespace runstone::test
