// FrameView: what the passes of the terrain need of a frame: the eye, the light and the look.
#pragma once
#include <glm/glm.hpp>

#include "client/render/day_light.hpp"
#include "client/render/depth_range.hpp"
#include "client/render/frame_look.hpp"

namespace runstone {

struct FrameView {
  glm::dvec3 eye{0};         // world voxels
  glm::mat4 clip{1};         // clip space from eye-relative space
  double far = 1000;         // what is farther is not drawn
  double shadow_far = 1000;  // what is farther is in no shadow
  DepthRange depth;
  double pixel = 0.002;  // the side of a pixel at distance 1
  DayLight light{};
  FrameLook look{};
};

}  // namespace runstone
