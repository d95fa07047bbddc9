// MaterialTextures: colour and look of each material, in two textures of 256 x 256 pixels, a pixel
// for each id. Thread: the GL thread.
#pragma once
#include "client/render/gl_handle.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

class MaterialTextures {
 public:
  MaterialTextures();
  void set(const MaterialTable& materials);
  /// Binds the textures to texture units `unit` and `unit` + 1, and sets the uniforms `palette` and
  /// `looks`. Requires that the program is in use.
  void bind(const GlProgram& program, GLint unit) const;

 private:
  GlTexture palette_;  // linear colour, alpha
  GlTexture looks_;    // variation, grain, emission, surface (surface_glsl.hpp)
};

}  // namespace runstone
