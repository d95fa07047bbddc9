// SkyPainter: fills what a frame leaves open with the sky: sun, moon, stars and clouds. Thread: the
// GL thread.
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "client/render/day_light.hpp"
#include "client/render/depth_range.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/noise_texture.hpp"

namespace runstone {

/// The view that the sky depends on.
struct SkyView {
  glm::mat4 clip{1};     // maps eye-relative coordinates to clip space
  glm::dvec3 eye{0};     // world voxels
  double pixel = 0.002;  // the side of a pixel at distance 1
  double seconds = 0;    // by which the clouds have drifted
  bool has_clouds = true;
};

/// Returns the eye in the texture of the clouds, and the way in it to a cloud straight above.
glm::vec3 cloud_place(const glm::dvec3& eye, double seconds);

class SkyPainter {
 public:
  SkyPainter();
  /// Draws the pixels that have the depth of the far plane. So it costs nothing behind the ground.
  /// Throws std::runtime_error with the driver's log if a shader does not compile.
  void draw(const SkyView& view, const DepthRange& depth, const DayLight& light,
            const NoiseTexture& noise);

 private:
  /// Returns the program that draws only these parts: drivers that draw with the processor compute
  /// both sides of a branch. Compiles it at its first use.
  GlProgram& program(bool has_stars, bool is_moon, bool has_clouds);

  std::array<GlProgram, 8> programs_;
  GlVertexArray array_;
};

}  // namespace runstone
