// The targets of meshing, judged from the rows. All of them are for chunks in their best axis
// order, in which holders keep them.
#pragma once
#include <vector>

#include "bench/edits/edit_case.hpp"
#include "bench/harness/target.hpp"
#include "bench/meshing/mesh_result.hpp"
#include "bench/meshing/shapes_case.hpp"

namespace runstone::bench {

std::vector<Target> mesh_targets(const std::vector<MeshRow>& rows, const EditTiming& edits);

/// Judges the mesh of shapes against that of cubes.
Target shapes_target(const ShapesTiming& shapes);

}  // namespace runstone::bench
