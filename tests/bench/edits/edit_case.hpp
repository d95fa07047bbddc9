// The edit case: a builder removes a voxel that shows, or puts one before it. Timed are the splice of the
// chunk's runs (apply_stack), the remeshing of its dirty layers, and then that of each neighbour whose border
// the voxel lies at. Each remeshed chunk is held to a full mesh of it. By the monotonic clock: each is too
// short for the one of the core.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/bench/worlds/voxel_world.hpp"

namespace runstone::bench {

struct EditTiming {
  std::size_t edits = 0;
  std::size_t at_borders = 0;  // of those: a neighbour is meshed as well, up to three
  // Medians over all edits.
  double apply_ns = 0, remesh_ns = 0;  // of the chunk
  double own_ns = 0;                   // both
  double all_ns = 0;                   // both, and the neighbours
  double full_mesh_ns = 0;             // of the chunk
  double border_all_ns = 0;            // as all_ns, over the edits at borders; 0 if there are none
};

/// Edits each volume that shows anything `per_volume` times, and takes every edit back, which is not among the
/// timed ones: a processor that has just gone that way is faster than one that follows a builder. Volumes are of `world`; what lies around their neighbours is cut from it. Seeded.
EditTiming measure_edits(const VoxelWorld& world, const std::vector<Volume>& volumes,
                         unsigned per_volume, std::uint64_t seed);

}  // namespace runstone::bench
