#include "client/render/depth_range.hpp"

#include <glm/ext/matrix_clip_space.hpp>

namespace runstone {

glm::mat4 DepthRange::projection(double fov_y, double aspect) const {
  return is_reversed_ ? glm::mat4(glm::perspectiveRH_ZO(fov_y, aspect, far_, near_))
                      : glm::mat4(glm::perspectiveRH_NO(fov_y, aspect, near_, far_));
}

void DepthRange::use() const {
  if (is_reversed_) glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(nearer());
  glClearDepth(is_reversed_ ? 0 : 1);
}

void DepthRange::reset() {
  if (glad_glClipControl != nullptr) glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDepthFunc(GL_LESS);
  glClearDepth(1);
}

void DepthRange::pull_polygons() const {
  const float sign = is_reversed_ ? 1 : -1;
  glPolygonOffset(sign * 1, sign * 2);
}

glm::vec3 DepthRange::distance_terms() const {
  const double reach = far_ - near_;
  return {near_ * far_, is_reversed_ ? reach : -reach, is_reversed_ ? near_ : far_};
}

}  // namespace runstone
