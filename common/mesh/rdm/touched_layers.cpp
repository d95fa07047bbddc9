#include "common/mesh/rdm/touched_layers.hpp"

#include "common/core/assert.hpp"
#include "common/mesh/rdm/side_axes.hpp"

namespace runstone::rdm {

TouchedLayers::TouchedLayers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                             const DirtyLayers& dirty,
                             const std::array<DirtyLayers, kDirectionCount>& beyond) {
  const auto sides = chunk.extent.sides();
  const Axis slow_axis = axes_of(chunk.order)[2];
  const auto slow_at = static_cast<std::size_t>(slow_axis);
  slow = dirty.layer[slow_at];
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const auto direction = static_cast<Direction>(d);
    const auto axis = static_cast<std::size_t>(axis_of(direction));
    const bool positive = is_positive(direction);
    const unsigned side = sides[axis];
    const LayerSet& changed = dirty.layer[axis];
    faces[d] =
        (changed | (positive ? changed >> 1 : changed << 1)) & ~LayerSet() >> (kSideMax - side);
    const RunChunk* const neighbour = neighbours[d];
    if (neighbour == nullptr) continue;
    for (std::size_t other = 0; other < 3; ++other) {
      RUNSTONE_ASSERT(other == axis || neighbour->extent.sides()[other] == sides[other]);
    }
    const unsigned touching = positive ? 0 : side_of(*neighbour, axis_of(direction)) - 1;
    if (!beyond[d].layer[axis][touching]) continue;
    faces[d].set(positive ? side - 1 : 0);
    if (axis == slow_at) {
      slow.set(positive ? side - 1 : 0);
    } else {
      slow |= beyond[d].layer[slow_at];
    }
  }
}

}  // namespace runstone::rdm
