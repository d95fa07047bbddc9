#include "client/render/eye_medium.hpp"

#include <algorithm>
#include <cmath>

namespace runstone {
namespace {

/// Where the fog hides everything, in voxels from the eye.
constexpr float kSolidFog = 1.6F, kLiquidFog = 26.0F;
/// The share of its colour that a solid shows, and that of the light in a liquid which is tinted.
constexpr float kSolidGleam = 0.06F, kTint = 0.65F;

glm::vec3 linear_colour(const MaterialColour& colour) {
  const auto linear = [](std::uint8_t v) { return std::pow(static_cast<float>(v) / 255.0F, 2.2F); };
  return {linear(colour[0]), linear(colour[1]), linear(colour[2])};
}

/// Everything fades into `colour`.
void set_fog(DayLight& light, const glm::vec3& colour, float range) {
  light.zenith = light.horizon = light.nadir = colour;
  light.glow = glm::vec3{0};
  light.stars = light.haze = 0;
  light.has_clouds = false;
  light.fog_start = light.fog_fade = 0;
  light.fog_end = std::min(light.fog_end, range);
}

}  // namespace

DayLight light_inside(const MaterialInfo& material, const DayLight& outside,
                      const glm::vec4& around) {
  DayLight out = outside;
  const glm::vec3 colour = linear_colour(material.colour);
  if (material.body == MaterialBody::liquid) {
    const glm::vec3 light = outside.ambient_up * around.w + outside.dark + glm::vec3(around);
    set_fog(out, colour * light, kLiquidFog);
    const glm::vec3 tint =
        glm::mix(glm::vec3{1}, colour / std::max({colour.r, colour.g, colour.b, 0.01F}), kTint);
    out.sun_colour *= tint;
    out.ambient_up *= tint;
    out.ambient_side *= tint;
    out.ambient_down *= tint;
  } else if (material.visibility == Visibility::opaque && material.shape.is_cube()) {
    // As bright as it is at night, whatever the hour: it is as dark as a cave.
    set_fog(out, colour * kSolidGleam / outside.exposure + 0.5F * outside.dark, kSolidFog);
  }
  return out;
}

}  // namespace runstone
