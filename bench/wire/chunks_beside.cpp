#include "bench/wire/chunks_beside.hpp"

#include <cstdint>
#include <map>

namespace runstone::bench {

std::vector<IndicesBeside> indices_beside(std::span<const Volume* const> volumes) {
  std::map<VoxelPos, std::size_t> places;
  for (std::size_t i = 0; i < volumes.size(); ++i) places[volumes[i]->origin] = i;
  std::vector<IndicesBeside> out(volumes.size());
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const VoxelPos origin = volumes[i]->origin;
    const auto edge = static_cast<std::int32_t>(volumes[i]->edge);
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const auto& beside = volumes[i]->scene.neighbours[d];
      if (!beside) continue;
      const ChunkCoord step = neighbour({}, static_cast<Direction>(d));
      const auto found = places.find(
          {origin.x + edge * step.x, origin.y + edge * step.y, origin.z + edge * step.z});
      if (found != places.end() && volumes[found->second]->scene.chunk == *beside)
        out[i][d] = found->second;
    }
  }
  return out;
}

}  // namespace runstone::bench
