// Stack cases: edits of all kinds on chunks of terrain, applied as one stack and one by one.
#pragma once
#include <cstdint>
#include <vector>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/runs/chunk.hpp"

namespace runstone::bench {

/// The mix of ten edits:
/// - by hand: seven set a voxel, one fills a box of sides 1 to 4, one a sphere of radius 1 or 2,
///   one a stroke of radius 1 over at most 6 voxels;
/// - by brush: four set a voxel, two fill a box of sides 1 to 8, two a sphere of radius 1 to 6, two
///   a stroke of radius 1 or 2 through two or three points anywhere.
enum class EditMix { by_hand, by_brush };
/// Returns edits of all kinds in the chunk of edge 32 at the origin, drawn from a seed. Three of
/// ten have a mask.
std::vector<EditDescriptor> mixed_edits(EditMix mix, std::uint64_t seed, std::size_t count);

/// Returns the chunk of the seeded world `terrain` at a place in the grid of chunks of edge 32, in
/// its cheapest order.
Chunk terrain_chunk(ChunkCoord at);

struct StackTiming {
  std::vector<double> stacked_us, one_by_one_us;  // one sample a repetition
};
/// Times both ways to apply the edits. Aborts if they give different chunks. The copy of the chunk
/// is not in the time.
StackTiming time_stack(const Chunk& chunk, const std::vector<EditDescriptor>& edits,
                       unsigned repetitions);

struct SpreadTiming {
  std::size_t chunks = 0;  // touched
  std::vector<double> us;  // one sample a repetition: all touched chunks, and the list of them
};
/// Times one edit over all chunks of the terrain that it touches.
SpreadTiming time_spread(const EditDescriptor& edit, unsigned repetitions);

}  // namespace runstone::bench
