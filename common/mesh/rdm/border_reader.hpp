// The border reader: reads the voxels beyond one side of a chunk into the form that the sweep
// needs, from the neighbour's runs or from its kept borders. Internal to rdm.
#pragma once
#include "common/core/coords.hpp"
#include "common/mesh/rdm/chunk_borders.hpp"
#include "common/mesh/rdm/row_range.hpp"
#include "common/mesh/rdm/scratch_state.hpp"
#include "common/mesh/rdm/side_axes.hpp"
#include "common/mesh/rdm/sweep_input.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::rdm {

/// A side of a chunk, and what lies beyond it.
struct BorderPlace {
  const RunChunk& chunk;
  Direction direction;
  const RunChunk* neighbour;  // null if it is missing
  const ChunkBorders* kept;   // of the neighbour; null if they are not kept
  SideAxes axes;
  Side side;
};

/// Replaces the voxels beyond one side in `borders`. Only the rows `wanted` of the side are valid
/// afterwards. Requires the palette of the chunk in `scratch`. Cost: O(runs of the neighbour); for
/// kept borders, or for a few rows, O(rows * (length + log runs)).
template <class Row>
void read_border(const BorderPlace& at_side, RowRange wanted, const VisibilityTable& visibility,
                 RdmScratch::State& scratch, Borders<Row>& borders);

}  // namespace runstone::rdm
