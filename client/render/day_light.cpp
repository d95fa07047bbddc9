#include "client/render/day_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace runstone {
namespace {

float ramp(float from, float to, float at) {
  const float t = std::clamp((at - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

void add_night(DayLight& out, float height, double angle) {
  out.night = 0.7F * (1 - ramp(-0.20F, 0.04F, height));
  out.stars = 1 - ramp(-0.24F, -0.04F, height);
  // A turn of the sky takes a day, as that of the sun, so that the stars move with the moon.
  out.star_angle = static_cast<float>(angle);
}

void add_clouds(DayLight& out) {
  out.has_clouds = true;
  const glm::vec3 sky = 0.5F * (out.zenith + out.horizon);
  const float bright = 1 - 0.5F * out.night;
  out.cloud_lit = bright * (0.45F * out.ambient_up + 1.05F * out.sun_colour + 0.5F * sky);
  out.cloud_shade = bright * (0.35F * out.ambient_up + 0.55F * out.sun_colour + 0.5F * sky);
}

void add_haze(DayLight& out, float far, bool has_far_ground, float dusk) {
  constexpr float kHalfMost = 4500;  // voxels; farther views do not get clearer air
  const float half = has_far_ground ? std::min(0.42F * far, kHalfMost) : 1.2F * far;
  out.fog_start = far * (has_far_ground ? 0.03F : 0.35F);
  out.fog_fade = far * (has_far_ground ? 0.80F : 0.60F);
  out.fog_end = far * 0.98F;
  out.haze = (1 + 0.6F * dusk) / half;
}

}  // namespace

DayLight day_light(double time_of_day, double far, bool has_far_ground) {
  const double turn = time_of_day - std::floor(time_of_day);
  const double angle = (turn - 0.25) * 2 * std::numbers::pi;
  const auto height = static_cast<float>(std::sin(angle));  // of the sun: -1 .. 1
  const float day = ramp(-0.10F, 0.30F, height);
  const float dusk = ramp(-0.22F, 0.02F, height) * (1 - ramp(0.10F, 0.45F, height));

  DayLight out;
  const bool is_moon = height < -0.06F;
  // The path of sun and moon leans towards +z, so that no shadow at noon is hidden below its wall.
  const float side = is_moon ? -1.0F : 1.0F;
  const glm::vec3 path{side * static_cast<float>(std::cos(angle)), std::max(side * height, 0.09F),
                       0.42F};
  out.sun_direction = glm::normalize(path);
  // Both lights are dark where one takes over from the other.
  const float strength = is_moon ? ramp(0.06F, 0.30F, -height) : ramp(-0.06F, 0.14F, height);
  const glm::vec3 sun = glm::mix(glm::vec3{1.30F, 0.55F, 0.22F}, glm::vec3{1.42F, 1.30F, 1.10F},
                                 ramp(0.0F, 0.45F, height));
  out.is_moon = is_moon;
  out.sun_colour = strength * (is_moon ? glm::vec3{0.13F, 0.16F, 0.23F} : sun);

  out.zenith = glm::mix(glm::vec3{0.004F, 0.008F, 0.024F}, glm::vec3{0.09F, 0.26F, 0.68F}, day);
  out.horizon = glm::mix(glm::vec3{0.014F, 0.022F, 0.044F}, glm::vec3{0.52F, 0.72F, 0.98F}, day);
  out.horizon = glm::mix(out.horizon, glm::vec3{0.85F, 0.42F, 0.20F}, 0.75F * dusk);
  out.zenith = glm::mix(out.zenith, glm::vec3{0.16F, 0.17F, 0.36F}, 0.5F * dusk);
  out.nadir = 0.75F * out.horizon;
  out.glow = strength * (is_moon ? glm::vec3{0.15F, 0.18F, 0.25F} : glm::vec3{1.0F, 0.70F, 0.38F});
  out.ambient_up =
      glm::mix(glm::vec3{0.050F, 0.062F, 0.100F}, glm::vec3{0.36F, 0.44F, 0.56F}, day) +
      dusk * glm::vec3{0.10F, 0.07F, 0.07F};
  // A quarter of the sunlight comes back from the ground, and sides see half of the ground.
  const glm::vec3 from_ground = 0.25F * out.sun_direction.y * out.sun_colour;
  out.ambient_side = 0.82F * out.ambient_up + 0.14F * out.horizon + 0.6F * from_ground;
  out.ambient_down = 0.40F * out.ambient_up + 0.06F * out.horizon + 0.7F * from_ground;
  // The eye adapts, so that a builder still sees the ground at night.
  out.exposure = glm::mix(2.4F, 0.95F, day) - 0.7F * dusk * (1 - day);
  // Lamps look brighter at night, but not by as much as the eye adapts.
  out.lamps = std::pow(out.exposure, -0.25F);
  out.dark = glm::vec3{0.048F, 0.051F, 0.058F} / out.exposure;
  add_night(out, height, angle);
  add_clouds(out);
  add_haze(out, static_cast<float>(far), has_far_ground, dusk);
  return out;
}

}  // namespace runstone
