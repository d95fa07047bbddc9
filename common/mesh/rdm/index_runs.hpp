// Palette indices of the runs of a chunk, or of some of them, as bytes. Internal to rdm.
#pragma once
#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_list.hpp"

namespace runstone::rdm {

/// Does what palette.list() does for all runs, and gives materials the same indices. While the
/// chunk has few materials, a vector of runs is compared with each of them, which is several times
/// as fast as looking each run up. The bytes are valid only if palette.fit_bytes() is true
/// afterwards. Requires room for an index a run at `out`. Cost: O(runs).
void index_runs(const NarrowRuns& runs, const VisibilityTable& visibility, ChunkPalette& palette,
                BytePaletteIndex* out);
void index_runs(const WideRuns& runs, const VisibilityTable& visibility, ChunkPalette& palette,
                BytePaletteIndex* out);

}  // namespace runstone::rdm
