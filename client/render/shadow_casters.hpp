// ShadowCasters: draws the depth of the chunks that cast shadows into a map of ShadowMaps. Thread:
// the GL thread.
#pragma once
#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "client/render/gl_handle.hpp"
#include "client/render/material_textures.hpp"
#include "client/render/shadow_maps.hpp"
#include "client/render/terrain_bodies.hpp"
#include "client/render/texture_array.hpp"

namespace runstone {

class ShadowCasters {
 public:
  /// The materials and textures with which the shapes of a pass are drawn. What their silhouettes and
  /// the holes of their pictures leave out casts no shadow.
  struct Surfaces {
    const MaterialTextures& materials;
    const TextureArray& textures;
  };
  /// Draws the next chunks of a pass (ShadowMaps::DrawTerrain). Throws std::runtime_error with the
  /// driver's log if a shader does not compile.
  bool draw(ShadowPass& pass, std::size_t quads_max, TerrainBodies& bodies, Surfaces surfaces);

 private:
  static constexpr unsigned kDepthHoles = 1, kDepthTextured = 2;
  /// The shapes of a chunk: its origin minus the middle of the pass, and in voxels modulo
  /// kPatternPeriod.
  struct ShapesInPass {
    QuadSpan shapes;
    glm::vec3 at, pattern;
  };
  /// Returns the program of a pass, by the bits above.
  const GlProgram& program_of(unsigned variant);
  /// Draws the shapes that draw() has put into shapes_.
  void draw_shapes(const ShadowPass& pass, QuadBuffer& quads, Surfaces surfaces);

  std::array<GlProgram, 4> programs_;  // by the bits, made when first used
  std::vector<ShapesInPass> shapes_;   // scratch
  std::vector<QuadSpan> spans_;        // scratch
};

}  // namespace runstone
