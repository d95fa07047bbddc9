// ShadowMaps: depth maps of the terrain as the sun sees it, in two cascades around the eye: a small
// one of high resolution, and a large one around it. A chunk uses the smallest cascade that holds
// all of it, so a fragment need not choose. A cascade does not depend on the direction of sight. It
// is drawn again only if
//   - the eye has moved by a part of its radius (its middle is a multiple of that part, and its
//     pixels keep their places in the world),
//   - a chunk within it changed, or the surfaces of all chunks did, or
//   - the sun moved.
// A cascade has two maps: one is shown, and the next one is drawn over several frames, a bounded
// number of quads in each. So an edit or a moving eye makes no frame much longer.
// Thread: the GL thread.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>

#include "client/render/day_light.hpp"
#include "client/render/frame_look.hpp"
#include "client/render/gl_handle.hpp"
#include "common/core/coords.hpp"

namespace runstone {

/// A map that is being drawn.
struct ShadowPass {
  glm::mat4 clip{1};                   // maps coordinates relative to the middle into the map's box
  glm::dvec3 middle{0};                // world voxels
  float pixel = 0;                     // side of a pixel, voxels
  std::optional<ChunkKey> drawn_to{};  // the last chunk that was drawn
};

class ShadowMaps {
 public:
  static constexpr int kCascades = 2;
  /// The quads that a frame draws into the next map of a cascade. The last chunk may exceed it.
  static constexpr std::size_t kQuadsAFrame = 1'500;

  /// Draws the chunks behind `drawn_to` into the map, in the order of their keys, until `quads_max`
  /// quads are drawn. Returns true if no chunk is left.
  using DrawTerrain = std::function<bool(ShadowPass& pass, std::size_t quads_max)>;

  ShadowMaps();
  /// Call it for each chunk that changed: a box in world voxels.
  void changed(const glm::dvec3& min, const glm::dvec3& max);
  /// Call it if any chunk may cast another shadow than before.
  void all_changed() {
    for (Cascade& cascade : cascades_) cascade.is_stale = true;
  }
  /// Draws the cascades that need it, and leaves another framebuffer bound. If `all` is false, it
  /// draws about kQuadsAFrame quads into the next map of each cascade, and shows that map once it
  /// is complete. A cascade without a map near the eye is drawn at once. The inner cascade has the
  /// radius `near`, the outer one `far`, in voxels.
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

 private:
  struct Cascade {
    double radius = 0;               // voxels; 0: not in use
    glm::dvec3 middle{0};            // of the shown map
    int shown = 0;                   // layer of the shown map; that of the next one is shown ^ 1
    bool is_drawn = false;           // there is a shown map
    bool is_stale = false;           // terrain changed since the newest map was begun
    std::optional<ShadowPass> next;  // the map that is being drawn
    std::array<GlFramebuffer, 2> framebuffers;  // of both maps
  };
  void set_quality(Quality quality);
  void resize(int side);
  void set_radii(double near, double far);
  glm::dvec3 middle_of(const Cascade& cascade, const glm::dvec3& eye) const;
  /// Returns true if the cascade is within reach of a change.
  bool is_touched(const Cascade& cascade, const glm::dvec3& middle, const glm::dvec3& change,
                  double reach) const;
  void begin(Cascade& cascade, const glm::dvec3& middle);
  /// Draws a part of the next map, and shows it if it is complete.
  void step(Cascade& cascade, std::size_t quads_max, const DrawTerrain& draw_terrain);

  std::array<Cascade, kCascades> cascades_;
  GlTexture maps_;  // an array of depth maps, two layers a cascade
  int side_ = 0;    // of a map, pixels
  glm::vec3 sun_{0};
  glm::dmat3 to_light_{1};  // rows: right, up and back of the light's view
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
