// The brush case: a builder uses a brush at visible places of a chunk. Each edit is made once, on the
// unedited chunk, because a processor that repeats an edit predicts its branches. There are three
// sorts of edits, in turn. After the first sort mesh_rdm_layers() is timed, after the second
// mesh_rdm(), and after the third the steps of LayerMesher. Each mesh of layers is compared with a
// whole mesh.
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
  /// The steps of LayerMesher, which meshes layers here even where mesh_rdm_layers() would mesh the
  /// whole chunk. Each is 0 if layers_share is 0.
  double sweep_ns = 0;  // reads runs and borders, makes quads
  double emit_ns = 0;   // joins the quads with those around them, and puts them into the mesh
  /// The share of edits after which mesh_rdm_layers() meshed only layers, 0 to 1.
  double layers_share = 0;
};

/// Measures `edits` edits of each sort, or fewer where most edits change nothing. `alone`: without the
/// neighbours of the volume. The places are drawn from a fixed seed. Returns a timing of no edits if
/// the mesh of the volume is empty. Aborts if a mesh of layers differs from the whole mesh.
BrushTiming measure_brush(const Volume& volume, const VisibilityTable& visibility,
                          const Brush& brush, bool alone, unsigned edits);

}  // namespace runstone::bench
