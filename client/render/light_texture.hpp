// LightTexture: the light field on the GPU, a texture of three dimensions that a shader reads with
// linear interpolation. Opaque voxels have no light, so places beside them are darker: one read
// gives light and the ambient occlusion of corners. Thread: the GL thread.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "client/render/gl_handle.hpp"
#include "client/render/light_field.hpp"

namespace runstone {

class LightTexture {
 public:
  LightTexture();
  /// Copies boxes of the field. The first call copies all of it.
  void copy(const LightField& field, std::span<const VoxelBox> changed);
  /// Binds the texture to a texture unit and sets the uniforms of RUNSTONE_FIELD_GLSL for an eye in
  /// world voxels. Requires that the program is in use, and copy() before.
  void bind(const GlProgram& program, GLint unit, const LightField& field,
            const glm::dvec3& eye) const;
  std::uint64_t byte_size() const { return bytes_; }

 private:
  GlTexture texture_;
  std::uint64_t bytes_ = 0;
};

/// vec4 field_light(vec3 relative): the light at a place relative to the eye. Red, green and blue
/// are the linear light of lamps, and the last is the share of the sky that is seen, 0 .. 1.
/// Outside the field, and at its rim, there are no lamps and all of the sky. `at` is 0 .. 1 inside
/// the field.
#define RUNSTONE_FIELD_GLSL                                                                \
  "uniform sampler3D light_field;\n"                                                       \
  "uniform vec3 field_scale, field_offset, field_turn;\n"                                  \
  "vec4 field_light(vec3 relative) {\n"                                                    \
  "  vec3 at = relative * field_scale + field_offset;\n"                                   \
  "  vec4 levels = textureLod(light_field, at + field_turn, 0.0) * (255.0 / 120.0);\n"     \
  "  vec3 from_middle = abs(at - 0.5);\n"                                                  \
  "  float rim = 0.5 - max(from_middle.x, max(from_middle.y, from_middle.z));\n"           \
  "  levels = mix(vec4(0.0, 0.0, 0.0, 1.0), levels, clamp(16.0 * rim - 1.0, 0.0, 1.0));\n" \
  "  return vec4(levels.rgb * levels.rgb, levels.a);\n"                                    \
  "}\n"

}  // namespace runstone
