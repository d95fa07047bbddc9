// ShadowMaps: depth maps of the terrain as the sun sees it, in two cascades around the eye: a small
// one of high resolution, and a large one around it. A chunk uses the smallest cascade that holds
// all of it, so its fragments read one map. A cascade does not depend on the direction of sight. It
// is drawn again only if
//   - the eye has moved by a part of its radius (its middle is a multiple of that part, and its
//     pixels keep their places in the world),
//   - a chunk within it changed, or
//   - the sun moved.
// Thread: the GL thread.
#pragma once
#include <array>
#include <functional>
#include <glm/glm.hpp>

#include "client/render/day_light.hpp"
#include "client/render/frame_look.hpp"
#include "client/render/gl_handle.hpp"

namespace runstone {

class ShadowMaps {
 public:
  static constexpr int kCascades = 2;

  /// Draws the terrain into a cascade: everything that `clip` maps into its box. `clip` maps
  /// coordinates relative to `middle`, in world voxels. `pixel` is the side of a pixel in voxels.
  using DrawTerrain =
      std::function<void(const glm::mat4& clip, const glm::dvec3& middle, float pixel)>;

  ShadowMaps();
  /// Call it for each chunk that changed: a box in world voxels.
  void changed(const glm::dvec3& min, const glm::dvec3& max);
  /// Draws the cascades that need it, and leaves another framebuffer bound. If `all` is false, at
  /// most one cascade that was drawn before is drawn again, so that a frame stays short.
  /// The inner cascade has the radius `near`, the outer one `far`, in voxels.
  void update(const glm::dvec3& eye, const DayLight& light, double near, double far,
              Quality quality, bool all, const DrawTerrain& draw_terrain);
  /// Binds the maps to a texture unit and sets the uniforms that all chunks share. Requires that
  /// the program is in use, and update() before.
  void bind(const GlProgram& program, GLint unit) const;
  /// Returns the cascade for a ball in world voxels: the smallest that holds it, or the last one.
  int cascade_of(const glm::dvec3& middle, double radius) const;
  /// Sets the uniforms of a cascade, for an eye in world voxels.
  void use(const GlProgram& program, int cascade, const glm::dvec3& eye) const;
  std::uint64_t byte_size() const;
  std::uint64_t cascades_drawn() const { return drawn_; }

 private:
  struct Cascade {
    double radius = 0;  // voxels; 0: not in use
    glm::dvec3 middle{0};
    glm::mat4 clip{1};  // relative to the middle
    bool is_drawn = false, is_stale = false;
    GlFramebuffer framebuffer;
  };
  void set_quality(Quality quality);
  void resize(int side);
  void set_radii(double near, double far);
  glm::dvec3 middle_of(const Cascade& cascade, const glm::dvec3& eye) const;
  void draw(Cascade& cascade, const glm::dvec3& middle, const DrawTerrain& draw_terrain);

  std::array<Cascade, kCascades> cascades_;
  GlTexture maps_;  // an array of depth maps, one layer a cascade
  int side_ = 0;    // of a map, pixels
  glm::vec3 sun_{0};
  glm::dmat3 to_light_{1};  // rows: right, up and back of the light's view
  std::uint64_t drawn_ = 0;
  unsigned next_ = 0;  // cascade to look at first
};

/// In the vertex shader: vec3 to_shadow(vec3 relative, vec3 normal), the place of a vertex in the
/// shadow map of its chunk, 0 .. 1. The normal moves it off its face, so that a face throws no
/// shadow on itself.
#define RUNSTONE_TO_SHADOW_GLSL                                                               \
  "uniform mat3 to_light;\n"                                                                  \
  "uniform vec3 shadow_scale, shadow_offset;\n"                                               \
  "uniform float shadow_bias;\n"                                                              \
  "vec3 to_shadow(vec3 relative, vec3 normal) {\n"                                            \
  "  return (to_light * (relative + normal * shadow_bias)) * shadow_scale + shadow_offset;\n" \
  "}\n"
/// In the fragment shader: float sunlit(vec3 at), the share of the sun that reaches a place of
/// to_shadow(), 0 .. 1. The sampler compares. That is much cheaper than four reads and comparisons
/// in the shader, also with llvmpipe.
#define RUNSTONE_SHADOW_GLSL                                                 \
  "uniform sampler2DArrayShadow shadow_maps;\n"                              \
  "uniform int shadow_layer;\n"                                              \
  "float sunlit(vec3 at) {\n"                                                \
  "  return texture(shadow_maps, vec4(at.xy, float(shadow_layer), at.z));\n" \
  "}\n"

}  // namespace runstone
