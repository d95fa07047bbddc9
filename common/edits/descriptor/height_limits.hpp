// HeightLimits: the range of heights in which a world may be edited. Server and client use the same
// check, so a client rejects the predictions that the server would reject. An edit is applied
// completely or not at all, and is never clipped, so that the log holds exactly the shape that the
// player chose.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Edits may cover voxels with y_min <= y < y_max. The default is the whole world.
struct HeightLimits {
  std::int32_t y_min = -kWorldLimit, y_max = kWorldLimit;
  friend bool operator==(const HeightLimits&, const HeightLimits&) = default;
};

/// Returns true if the limits lie inside the world and hold at least one height.
bool validate(const HeightLimits& limits);

/// Returns true if every voxel of the geometry (mask ignored) lies between the limits. Requires a
/// valid descriptor. Cost: O(1).
bool within(const EditDescriptor& edit, const HeightLimits& limits);

}  // namespace runstone
