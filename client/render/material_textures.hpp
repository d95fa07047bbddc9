// MaterialTextures: colour and look of each material, in two textures of 256 x 256 pixels, a pixel
// for each id. Thread: the GL thread.
#pragma once
#include <vector>

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
  /// Returns, by id, true for each material that RUNSTONE_GLOSS_GLSL does not change.
  const std::vector<bool>& matt() const { return matt_; }

 private:
  std::vector<bool> matt_;
  GlTexture palette_;  // linear colour, alpha
  GlTexture looks_;    // variation, grain, emission, surface (surface_glsl.hpp)
};

}  // namespace runstone
