// Strand case: what an edit costs on the world strand, the one thread that orders all edits.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace runstone::bench {

inline constexpr std::size_t kStrandEdits = 10'000;
inline constexpr std::uint8_t kStrandLevels = 6;

/// Processor time of the world strand in microseconds an edit, one sample a repetition.
struct StrandTiming {
  std::vector<double> near_us;  // nobody sees tiles
  std::vector<double> far_us;   // everybody sees kStrandLevels levels of tiles
};

/// Measures both in turn. In a world of terrain of edge 32, 20 players in one place each see 6
/// chunks around. A repetition is 10 s with 20 ticks a second, in which they set kStrandEdits
/// single voxels together. The time is that of all calls of WorldServer: received edits, commits,
/// ticks, and sending tiles anew that edits changed. Work of other threads is not in it: sockets,
/// disk, and making tiles.
StrandTiming time_strand(unsigned repetitions);

}  // namespace runstone::bench
