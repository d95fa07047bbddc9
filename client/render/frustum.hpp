// Frustum: the six planes of a view, for skipping chunks outside it. Coordinates are relative to
// the eye.
#pragma once
#include <array>
#include <glm/glm.hpp>

namespace runstone {

class Frustum {
 public:
  /// Takes the planes from a matrix that maps eye-relative coordinates to clip space. Source: Gribb
  /// and Hartmann 2001 (sums of rows of the matrix). `is_reversed` says that clip space ends at
  /// depth 0, not at -1 (DepthRange).
  explicit Frustum(const glm::mat4& clip, bool is_reversed = false) {
    const glm::mat4 t = glm::transpose(clip);
    planes_ = {t[3] + t[0], t[3] - t[0], t[3] + t[1],
               t[3] - t[1], t[3] - t[2], is_reversed ? t[2] : t[3] + t[2]};
  }
  /// Returns false only if the whole box is outside one plane.
  bool may_see(const glm::vec3& min, const glm::vec3& max) const {
    for (const glm::vec4& p : planes_) {
      const glm::vec3 far_corner{p.x > 0 ? max.x : min.x, p.y > 0 ? max.y : min.y,
                                 p.z > 0 ? max.z : min.z};
      if (glm::dot(glm::vec3(p), far_corner) + p.w < 0) return false;
    }
    return true;
  }

 private:
  std::array<glm::vec4, 6> planes_;
};

}  // namespace runstone
