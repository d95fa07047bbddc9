// The shapes case: the chunks of a village with stairs, slabs, panes, fences and plants are meshed
// with their shapes, and again as if every material were a cube.
#pragma once
#include <cstddef>

namespace runstone::bench {

struct ShapesTiming {
  std::size_t chunks = 0;
  double share = 0;  // of the voxels that are not empty, those with a shape
  // Medians of the repetitions: a chunk on average.
  double cubes_ns = 0, shapes_ns = 0;
  std::size_t cube_quads = 0;                  // all chunks, meshed as cubes
  std::size_t quads = 0, quads_of_shapes = 0;  // all chunks, meshed with shapes
};

/// Meshes 16 chunks of 32 voxels with two layers of the ground.
ShapesTiming measure_shapes(unsigned repetitions);

}  // namespace runstone::bench
