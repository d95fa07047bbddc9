// DepthRange: how the distances of a frame become depths. A floating-point number is finest near 0,
// so depth is reversed: 1 at the near plane and 0 at the far plane. Two faces a voxel apart then
// differ in depth up to 32,768 voxels away. Source: Reed, "Depth Precision Visualized", 2015.
// Where OpenGL cannot map depth that way (clip_control()), depth is 0 at the near plane, as usual.
#pragma once
#include <glm/glm.hpp>

#include "client/render/gl_functions.hpp"

namespace runstone {

class DepthRange {
 public:
  /// The distances of the planes are in voxels, 0 < near < far. Requires a current context.
  DepthRange(double near, double far)
      : near_(near), far_(far), is_reversed_(clip_control() != nullptr) {}

  bool is_reversed() const { return is_reversed_; }

  /// Returns a projection for a vertical field of view in radians.
  glm::mat4 projection(double fov_y, double aspect) const;

  /// Sets the test, the clear value and the mapping of depth for a frame. A fragment is drawn if it
  /// is nearer than what is there.
  void use() const;
  /// Sets them to what OpenGL starts with. Shadow maps are drawn with that.
  static void reset();

  /// Returns the function that also passes what is as far.
  GLenum not_farther() const { return is_reversed_ ? GL_GEQUAL : GL_LEQUAL; }
  GLenum nearer() const { return is_reversed_ ? GL_GREATER : GL_LESS; }

  /// Returns v such that the distance along the direction of sight is v.x / (v.y * depth + v.z).
  glm::vec3 distance_terms() const;

 private:
  double near_, far_;
  bool is_reversed_;
};

/// Returns a projection with which polygons lie a little in front of themselves, at the same
/// pixels: the space around the eye is 1/2048 smaller. `clip` has the eye at its origin. An offset
/// that grows with the slope would draw faces that are seen edge-on in front of everything.
glm::mat4 in_front(const glm::mat4& clip);

}  // namespace runstone
