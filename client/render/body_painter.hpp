// BodyPainter: draws the bodies of players as lit boxes: legs, torso, arms, and a head that turns
// with the direction of sight. Thread: that of the renderer.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "client/render/body.hpp"
#include "client/render/day_light.hpp"
#include "client/render/gl_handle.hpp"

namespace runstone {

class BodyPainter {
 public:
  /// Throws std::runtime_error with the driver's log if the shader does not compile.
  BodyPainter();
  /// Returns the light at a place in world voxels, as Terrain::light_at() does.
  using LightAt = std::function<glm::vec4(const glm::dvec3& at)>;
  /// `clip` maps eye-relative coordinates to clip space. `eye` is in world voxels. A body has the
  /// light of the place of its chest.
  void draw(std::span<const Body> bodies, const glm::dvec3& eye, const glm::mat4& clip,
            const DayLight& light, const LightAt& light_at);

 private:
  GlProgram program_;
  GlVertexArray array_;
};

}  // namespace runstone
