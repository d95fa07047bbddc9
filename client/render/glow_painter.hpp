// GlowPainter: draws the glow of lamps over a frame. A glow is a ball of air. The share of the
// sight through it that lies before the ground decides how bright it is, so no edge cuts it.
// Thread: the GL thread.
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "client/render/day_light.hpp"
#include "client/render/depth_range.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/lamp_glow.hpp"

namespace runstone {

class GlowPainter {
 public:
  /// The greatest number of glows in a frame.
  static constexpr std::size_t kGlowsMax = 256;

  /// Throws std::runtime_error with the driver's log if the shader does not compile.
  GlowPainter();
  /// Draws the glows. `clip` maps eye-relative coordinates to clip space. `scene_depth` is a
  /// texture with the depth of the opaque faces, which must not be bound for drawing.
  void draw(std::span<const GlowInView> glows, const glm::mat4& clip, const DepthRange& depth,
            const DayLight& light, GLuint scene_depth);

 private:
  GlProgram program_;
  GlVertexArray array_;
  GlBuffer vertices_;
  std::vector<float> staged_;  // kept for its capacity
};

}  // namespace runstone
