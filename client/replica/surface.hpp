// Surface: the height of the ground in a column, as a replica shows it.
#pragma once
#include <cstdint>
#include <optional>

#include "client/replica/replica.hpp"

namespace runstone {

/// Returns y of the highest shown voxel of the column that is not empty and lies within the
/// replica's view. Returns nullopt without a view, or if there is no such voxel. Cost: O(height of
/// the view * log runs).
std::optional<std::int32_t> surface_of(const Replica& replica, std::int32_t x, std::int32_t z);

}  // namespace runstone
