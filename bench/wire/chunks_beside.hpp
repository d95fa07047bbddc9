// The chunks that lie beside a chunk among those that are measured.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "bench/worlds/voxel_world.hpp"
#include "common/core/coords.hpp"

namespace runstone::bench {

/// The index of the chunk beside a chunk in each direction, or nullopt if it is not measured.
using IndicesBeside = std::array<std::optional<std::size_t>, kDirectionCount>;

/// Returns, for each volume, the indices of the volumes whose chunks are its neighbours. A volume
/// beside it with other voxels than its neighbour has none of its indices. Requires no null and one
/// edge.
std::vector<IndicesBeside> indices_beside(std::span<const Volume* const> volumes);

}  // namespace runstone::bench
