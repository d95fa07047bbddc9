// Surface: the ground of a column as a replica shows it.
#pragma once
#include <cstdint>
#include <optional>

#include "client/replica/replica.hpp"

namespace runstone {

/// y of the highest shown voxel of the column that is not empty, within the replica's view; nothing without a
/// view, or if none is shown. O(height of the view * log runs).
std::optional<std::int32_t> surface_of(const Replica& replica, std::int32_t x, std::int32_t z);

}  // namespace runstone
