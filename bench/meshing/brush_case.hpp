// The brush case: a builder uses a brush at visible places of a chunk. Each edit is made on the
// chunk as it was, once, because a processor that repeats an edit predicts its branches. Edits
// whose layers are meshed again alternate with edits after which the whole chunk is meshed. Each
// mesh of layers is compared with a whole mesh.
#pragma once
#include <cstdint>

#include "bench/meshing/brush.hpp"
#include "bench/worlds/voxel_world.hpp"

namespace runstone::bench {

/// Medians over the edits, in ns.
struct BrushTiming {
  unsigned edits = 0;
  double apply_ns = 0;   // the splice of the chunk's runs
  double layers_ns = 0;  // mesh_rdm_layers()
  double whole_ns = 0;   // mesh_rdm()
  /// The steps inside mesh_rdm_layers(), over the edits of which only layers were meshed. Each is
  /// 0 if there were none.
  double sweep_ns = 0;      // runs and borders read, quads made
  double emit_ns = 0;       // quads joined with those around them, and put into the mesh
  double layers_share = 0;  // of the edits of which only layers were meshed
};

/// Measures `edits` edits of each sort. `alone`: without the neighbours of the volume. The places
/// are drawn from a fixed seed. Returns a timing of no edits if the mesh of the volume is empty.
BrushTiming measure_brush(const Volume& volume, const VisibilityTable& visibility,
                          const Brush& brush, bool alone, unsigned edits);

}  // namespace runstone::bench
