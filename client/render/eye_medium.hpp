// The light of a frame whose eye is inside a voxel of a solid, of glass or of water. Pure.
#pragma once
#include <glm/glm.hpp>

#include "client/render/day_light.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the light of a frame whose eye is in a voxel of `material`.
///   - In a solid, a dense and dark fog of its colour hides what lies behind the next voxels, so
///     nobody sees through the ground.
///   - In a liquid, the fog has its colour and a short range, and sun and sky are tinted.
/// `around` is the light at the eye: red, green and blue of lamps, and the share of the sky, 0 ..
/// 1.
DayLight light_inside(const MaterialInfo& material, const DayLight& outside,
                      const glm::vec4& around);

}  // namespace runstone
