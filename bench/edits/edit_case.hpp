// The edit case: a builder removes a visible voxel, or puts one before it. Three times are
// measured:
// - the splice of the chunk's runs (apply_stack);
// - the remesh of its dirty layers;
// - the remesh of each neighbour whose border the voxel touches.
// Each remeshed chunk is compared with a full mesh of it. The times are those of the monotonic
// clock, because each is too short for the clock of the thread's processor time.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/worlds/voxel_world.hpp"

namespace runstone::bench {

struct EditTiming {
  std::size_t edits = 0;
  std::size_t at_borders = 0;  // those in which one to three neighbours are meshed as well
  // Medians over all edits.
  double apply_ns = 0, remesh_ns = 0;  // of the chunk
  double chunk_ns = 0;                 // apply_ns and remesh_ns together
  double all_ns = 0;                   // chunk_ns and the neighbours
  double full_mesh_ns = 0;             // of the chunk
  double border_all_ns = 0;            // as all_ns, over the edits at borders; 0 if there are none
};

/// Makes `per_volume` edits in each volume whose mesh is not empty. Every edit is taken back.
/// Taking back is not in the time, because a processor that has just executed the same branches is
/// faster than one that follows a builder. The volumes are parts of `world`, from which the chunks
/// around the neighbours are cut. The edits are drawn from a fixed seed.
EditTiming measure_edits(const VoxelWorld& world, const std::vector<Volume>& volumes,
                         unsigned per_volume, std::uint64_t seed);

}  // namespace runstone::bench
