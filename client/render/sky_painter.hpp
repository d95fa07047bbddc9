// SkyPainter: fills a frame with the sky, the sun and the moon. Thread: the GL thread.
#pragma once
#include <glm/glm.hpp>

#include "client/render/day_light.hpp"
#include "client/render/gl_handle.hpp"

namespace runstone {

class SkyPainter {
 public:
  /// Throws std::runtime_error with the driver's log if the shader does not compile.
  SkyPainter();
  /// Draws over the whole target, without depth. `clip` maps eye-relative coordinates to clip
  /// space.
  void draw(const glm::mat4& clip, const DayLight& light);

 private:
  GlProgram program_;
  GlVertexArray array_;
};

}  // namespace runstone
