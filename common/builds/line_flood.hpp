// LineFlood: the voxels that are connected with one place by steps along the axes. It reads runs:
// the lines of a chunk along x are stretches of voxels, and a stretch is reached as a whole.
// Internal to floods and to the tools that take connected voxels. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/chunk_lookup.hpp"

namespace runstone {

/// The part that a material has in a flood.
enum class FloodPart : std::uint8_t {
  stops,   // the flood does not enter it
  passed,  // it spreads through it
  taken,   // it spreads through it, and its voxels belong to the result
};

enum class FloodFault : std::uint8_t {
  blocked,          // the flood cannot be at the start
  missing_chunk,    // it reaches a chunk that is not known
  too_many_voxels,  // it has more than voxels_max
};

struct FloodLimits {
  std::int32_t level = std::numeric_limits<std::int32_t>::max();  // the highest layer
  std::uint64_t voxels_max = 0;                                   // taken or passed
};

class LineFlood {
 public:
  /// Voxels [first, last) of a line along x that the flood can enter, of one run.
  struct Stretch {
    std::uint8_t first, last;
    bool is_taken, is_reached;
  };
  /// The stretches of a chunk by line. Line y + edge * z has those from begins[line] to
  /// begins[line + 1].
  struct Lines {
    std::vector<std::uint32_t> begins;
    std::vector<Stretch> stretches;
  };

  /// Requires chunks of `edge` voxels a side that stay as they are during run().
  LineFlood(std::int32_t edge, const ChunkLookup& chunk_at,
            std::function<FloodPart(Material)> part_of, const FloodLimits& limits)
      : edge_(edge), chunk_at_(chunk_at), part_of_(std::move(part_of)), limits_(limits) {}

  /// Floods from a start that lies not above the level. Returns nullopt if all is reached. The
  /// result does not depend on the axis orders of the chunks. Cost: O(stretches of the chunks that
  /// are reached, and their runs); it stops soon after voxels_max.
  std::optional<FloodFault> run(VoxelPos start);

  /// Returns the chunks that were reached, with all their stretches.
  const std::map<ChunkCoord, Lines>& chunks() const { return chunks_; }
  /// Returns the box of the voxels that were taken.
  const VoxelBox& box() const { return box_; }
  /// Returns the number of voxels that were taken or passed.
  std::uint64_t voxels() const { return voxels_; }

 private:
  /// A stretch that was reached.
  struct Reached {
    ChunkCoord chunk;
    Lines* lines;
    std::int32_t y, z;  // in the chunk
    std::uint32_t stretch;
  };

  Lines* lines_of(ChunkCoord at);
  void read(const RunChunk& chunk, Lines& out) const;
  void reach(ChunkCoord chunk, Lines* lines, std::int32_t y, std::int32_t z, int first, int last);
  void spread(const Reached& from);
  void reach_beyond(const Reached& from, Direction d, std::int32_t y, std::int32_t z, int first,
                    int last);

  const std::int32_t edge_;
  const ChunkLookup& chunk_at_;
  const std::function<FloodPart(Material)> part_of_;
  const FloodLimits limits_;
  std::map<ChunkCoord, Lines> chunks_;
  std::vector<Reached> waiting_;
  VoxelBox box_;
  std::uint64_t voxels_ = 0;
  std::optional<FloodFault> fault_;
};

}  // namespace runstone
