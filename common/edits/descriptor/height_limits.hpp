// HeightLimits: between which heights a world may be edited. Server and client ask the same question, so a
// prediction is refused where the server would refuse. An edit is taken whole or not at all, never clipped:
// what a player shapes and what the log says stay the same thing.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Voxels with y_min <= y < y_max. By default the whole world.
struct HeightLimits {
  std::int32_t y_min = -kWorldLimit, y_max = kWorldLimit;
  friend bool operator==(const HeightLimits&, const HeightLimits&) = default;
};

/// Whether the limits lie inside the world and hold at least one height.
bool validate(const HeightLimits& limits);

/// Whether every voxel of the geometry (mask ignored) lies between the limits. Requires a valid descriptor.
/// O(1).
bool within(const EditDescriptor& edit, const HeightLimits& limits);

}  // namespace runstone
