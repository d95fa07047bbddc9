// Rights case: whether a player may set a voxel, in a world with many protected boxes.
#pragma once
#include <cstddef>
#include <vector>

namespace runstone::bench {

/// How the boxes lie.
enum class Ground {
  spread,  // mostly apart, as claims of players; a third of them are columns of the whole world
  nested   // the same among regions of 1,000 to 6,000 voxels a side, one for twenty boxes
};

/// Makes a world with so many protected boxes. Returns the microseconds of `decisions` decisions
/// about voxels at random places among them, one sample a repetition. Half of the players own
/// boxes.
std::vector<double> time_rights(Ground ground, std::size_t boxes, std::size_t decisions,
                                unsigned repetitions);

}  // namespace runstone::bench
