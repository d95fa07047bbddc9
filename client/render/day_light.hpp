// DayLight: the light of a moment of the day: sun or moon, sky and ambient light. Colours are
// linear, without an upper bound. Pure.
#pragma once
#include <glm/glm.hpp>

namespace runstone {

struct DayLight {
  glm::vec3 sun_direction{0, 1, 0};  // towards the sun; at night towards the moon
  glm::vec3 sun_colour{1};
  glm::vec3 zenith{0}, horizon{0}, nadir{0};  // of the sky
  glm::vec3 glow{0};                          // around the sun
  glm::vec3 ambient_up{0}, ambient_down{0};   // on faces that look up and down
  glm::vec3 dark{0};                          // everywhere, so that caves are not black
  float lamps = 1;                            // factor of the light of lamps
  float exposure = 1;
  float fog_start = 0, fog_end = 1;  // voxels from the eye; terrain has vanished at fog_end
};

/// Returns the light at a time of day (FrameLook::time_of_day). `far` is the distance in voxels at
/// which fog hides everything. `has_far_ground`: the view has tiles, so fog begins nearer in
/// proportion, because the last half of a long distance is only some pixels high.
DayLight day_light(double time_of_day, double far, bool has_far_ground = false);

}  // namespace runstone
