// The chunk sweep: prepares the input of a layer sweep from a chunk and its neighbours, and runs
// the sweep. Internal to rdm.
#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>

#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/rdm/scratch_state.hpp"
#include "common/mesh/rdm/sweep_input.hpp"
#include "common/mesh/rdm/sweep_part.hpp"

namespace runstone::rdm {

/// The chunk to sweep and what surrounds it.
struct SweepRequest {
  const RunChunk& chunk;
  const MeshNeighbours& neighbours;
  const MeshBorders& borders;
  const VisibilityTable& visibility;
  ChunkBorders* chunk_borders;  // becomes the borders of the chunk if it is not null
};

/// Adjacent runs of a chunk.
struct RunRange {
  std::size_t first = 0, end = 0;
  std::size_t count() const { return end - first; }
};

/// Assigns palette indices to the materials of some runs and lists the index of each run. The
/// result is valid until the next call with this scratch. Cost: O(runs of the range).
IndexedRuns index_runs(const RunChunk& chunk, RunRange range, const VisibilityTable& visibility,
                       RdmScratch::State& scratch);

/// Puts the quads of a part of the chunk into the buckets of the scratch. Requires the runs of that
/// part with at least one material that is not empty, and what sweep_layers() requires of `rows`.
/// `chunk_borders` requires the whole chunk as the part.
template <class Row>
void sweep_chunk(const SweepRequest& request, const IndexedRuns& runs, const SweepPart<Row>& part,
                 RdmScratch::State& scratch, RowScratch<Row>& rows);

/// Calls f with the RowScratch whose rows hold the longest side of a chunk.
template <class F>
void with_rows(const Extent& extent, RdmScratch::State& scratch, F&& f) {
  const auto sides = extent.sides();
  const auto longest = *std::max_element(sides.begin(), sides.end());
  const auto call = [&f](auto& rows) {
    if (!rows) rows = std::make_unique<typename std::decay_t<decltype(rows)>::element_type>();
    f(*rows);
  };
  // The plain path uses rows of 64 bits for all sides up to 64. Its speed does not matter.
  if (longest <= 32 && !scratch.plain) {
    call(scratch.rows_32);
  } else if (longest <= 64) {
    call(scratch.rows_64);
  } else {
    call(scratch.rows_128);
  }
}

}  // namespace runstone::rdm
