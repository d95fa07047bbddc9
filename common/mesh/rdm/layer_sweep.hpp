// The layer sweep: meshes a chunk in one pass over the layers of its slowest axis. Only two layers
// are present at any time: as palette indices, made from the runs that lie in them, and as rows of
// bits (one row per line, one bit per voxel). docs/meshing.md has a diagram. Internal to rdm. A
// layer passes through these files in order:
//   layer_builder-inl.hpp   indices and rows of a layer, from the runs and the borders
//   chunk_sides-inl.hpp     the chunk's own six sides, for the meshes around it
//   layer_sweep-inl.hpp     the loop over the layers, the faces of six sides, the rows that differ
//   strip_tracer-inl.hpp    strips that end and begin in those rows (row_strips.hpp)
//   quad_emitter-inl.hpp    strips as quads, in the bucket of their layer
#pragma once
#include "common/mesh/rdm/sweep_input.hpp"
#include "common/mesh/rdm/sweep_part.hpp"
#include "common/mesh/rdm/sweep_state.hpp"

namespace runstone::rdm {

/// Puts the quads of a part of the chunk into the buckets, with the best instruction set of the
/// machine. Requires sides up to kRowBits<Row>, runs that cover the layers which the sweep reads,
/// and at least one material that is not empty.
/// If the part does not begin with the first layer, the strips that reach its first layer are in
/// `state.open` and `state.start_layer`. Those that reach beyond the part are there afterwards.
void sweep_layers(const SweepInput& input, const Borders<Row32>& borders,
                  const SweepPart<Row32>& part, SweepState<Row32>& state);
void sweep_layers(const SweepInput& input, const Borders<Row64>& borders,
                  const SweepPart<Row64>& part, SweepState<Row64>& state);
void sweep_layers(const SweepInput& input, const Borders<Row128>& borders,
                  const SweepPart<Row128>& part, SweepState<Row128>& state);

/// The plain path of sweep_layers(): works on one row and one index at a time. The results of
/// sweep_layers() must equal its results.
void sweep_layers_plain(const SweepInput& input, const Borders<Row64>& borders,
                        const SweepPart<Row64>& part, SweepState<Row64>& state);
void sweep_layers_plain(const SweepInput& input, const Borders<Row128>& borders,
                        const SweepPart<Row128>& part, SweepState<Row128>& state);

}  // namespace runstone::rdm
