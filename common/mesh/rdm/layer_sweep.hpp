// The layer sweep: meshes a chunk in one pass over the layers of its slowest axis. Only two layers are ever
// there, as codes made from the runs that lie in them, and as rows of bits (one row per line, one bit per
// voxel). Internal to rdm; docs/meshing.md draws it. The rooms of the sweep, in the order in which a layer
// goes through them:
//   layer_builder-inl.hpp   codes and rows of a layer, from the runs and the borders
//   chunk_sides-inl.hpp       the chunk's own six sides, for the meshes around it
//   layer_sweep.cpp         the loop over the layers, faces of six sides, and which rows of them differ
//   strip_tracer-inl.hpp    strips that end and begin in those rows (strip_lanes-inl.hpp, row_strips.hpp)
//   quad_emitter-inl.hpp     strips as quads, in the bucket of their layer
#pragma once
#include "common/mesh/rdm/sweep_input.hpp"
#include "common/mesh/rdm/sweep_state.hpp"

namespace runstone::rdm {

/// Puts the quads of the chunk into the buckets. Requires sides up to kRowBits<Row>, runs that tile the
/// extent and at least one material that is not empty. By the best instructions the machine has.
void sweep_layers(const SweepInput& input, const Borders<Row64>& borders, SweepState<Row64>& state);
void sweep_layers(const SweepInput& input, const Borders<Row128>& borders,
                  SweepState<Row128>& state);

/// The same, a row and a index at a time: the plain path that the others must agree with.
void sweep_layers_plain(const SweepInput& input, const Borders<Row64>& borders,
                        SweepState<Row64>& state);
void sweep_layers_plain(const SweepInput& input, const Borders<Row128>& borders,
                        SweepState<Row128>& state);

}  // namespace runstone::rdm
