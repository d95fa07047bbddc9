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
  /// Calls glPolygonOffset() so that the polygons come a little nearer.
  void pull_polygons() const;

  /// Returns v such that the distance along the direction of sight is v.x / (v.y * depth + v.z).
  glm::vec3 distance_terms() const;

 private:
  double near_, far_;
  bool is_reversed_;
};

}  // namespace runstone
