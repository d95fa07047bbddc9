#include "client/render/depth_range.hpp"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

namespace runstone {
namespace {

void clear_depth_to(float depth) {
  is_gl_es() ? glClearDepthf(depth) : glClearDepth(static_cast<double>(depth));
}

}  // namespace

glm::mat4 DepthRange::projection(double fov_y, double aspect) const {
  return is_reversed_ ? glm::mat4(glm::perspectiveRH_ZO(fov_y, aspect, far_, near_))
                      : glm::mat4(glm::perspectiveRH_NO(fov_y, aspect, near_, far_));
}

void DepthRange::use() const {
  if (is_reversed_) clip_control()(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(nearer());
  clear_depth_to(is_reversed_ ? 0 : 1);
}

void DepthRange::reset() {
  if (const auto set = clip_control()) set(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDepthFunc(GL_LESS);
  clear_depth_to(1);
}

glm::vec3 DepthRange::distance_terms() const {
  const double reach = far_ - near_;
  return {near_ * far_, is_reversed_ ? reach : -reach, is_reversed_ ? near_ : far_};
}

glm::mat4 in_front(const glm::mat4& clip) { return glm::scale(clip, glm::vec3(1 - 1.0F / 2048)); }

}  // namespace runstone
