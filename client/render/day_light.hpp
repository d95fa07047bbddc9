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
  /// On faces that look up, to a side and down. Sides see half of the sky, and the ground before
  /// them that the sun lights.
  glm::vec3 ambient_up{0}, ambient_side{0}, ambient_down{0};
  glm::vec3 dark{0};  // everywhere, so that caves are not black
  float lamps = 1;    // factor of the light of lamps
  float exposure = 1;
  float night = 0;          // share of the colour that dim places lose, as eyes see at night
  bool is_moon = false;     // sun_direction is that of the moon
  float stars = 0;          // brightness of the stars, 0: none
  float star_angle = 0;     // by which the sky has turned since midnight, radians
  bool has_clouds = false;  // they cover about half of the sky
  glm::vec3 cloud_lit{0}, cloud_shade{0};
  /// Haze begins fog_start voxels from the eye. From fog_fade on terrain fades into the sky, and it
  /// has vanished at fog_end.
  float fog_start = 0, fog_fade = 0, fog_end = 1;
  float eye_height = 0;  // y of the eye, which day_light() does not know
  float haze = 0;        // of a voxel, at height 0: half of the light is lost after 1 / haze voxels
};

/// Returns the light at a time of day (FrameLook::time_of_day). `far` is the distance in voxels at
/// which fog hides everything. `has_far_ground`: the view has tiles, so fog begins nearer in
/// proportion, because the last half of a long distance is only some pixels high. Haze is thicker
/// in the morning and in the evening.
DayLight day_light(double time_of_day, double far, bool has_far_ground = false);

}  // namespace runstone
