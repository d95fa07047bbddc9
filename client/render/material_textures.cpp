#include "client/render/material_textures.hpp"

#include <cmath>
#include <vector>

#include "client/render/surface_glsl.hpp"
#include "common/materials/default_look.hpp"

namespace runstone {
namespace {

float linear_from_srgb(std::uint8_t v) { return std::pow(static_cast<float>(v) / 255.0F, 2.2F); }

float share_of(std::uint8_t percent) { return static_cast<float>(percent) / kLookShareMax; }

/// Returns the pattern and, as its fraction, the roughness. surface_glsl.hpp takes them apart.
float surface_code(const MaterialLook& look, MaterialBody body) {
  const float pattern =
      body == MaterialBody::liquid ? kLiquidSurface : static_cast<float>(look.pattern);
  return pattern + kRoughnessScale * share_of(look.roughness);
}

void fill(GLuint texture, const std::vector<float>& texels) {
  glBindTexture(GL_TEXTURE_2D, texture);
  // 16-bit floats keep dark colours smooth.
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, 256, 256, 0, GL_RGBA, GL_FLOAT, texels.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

}  // namespace

MaterialTextures::MaterialTextures() : palette_(GlTexture::make()), looks_(GlTexture::make()) {}

void MaterialTextures::set(const MaterialTable& materials) {
  std::vector<float> palette(std::size_t{256} * 256 * 4, 1.0F);
  std::vector<float> looks(std::size_t{256} * 256 * 4, 0.0F);
  matt_.assign(materials.size(), false);
  for (std::size_t id = 0; id < materials.size(); ++id) {
    const MaterialInfo& row = materials[static_cast<Material>(id)];
    // Light is added in linear space, so the palette is stored in linear space.
    for (std::size_t c = 0; c < 3; ++c) palette[id * 4 + c] = linear_from_srgb(row.colour[c]);
    palette[id * 4 + 3] = static_cast<float>(row.colour[3]) / 255.0F;
    const MaterialLook look = look_of(row);
    looks[id * 4] = share_of(look.variation);
    looks[id * 4 + 1] = share_of(look.grain);
    looks[id * 4 + 2] = share_of(look.emission);
    looks[id * 4 + 3] = surface_code(look, row.body);
    matt_[id] = look.roughness >= kMattRoughness;
  }
  fill(palette_.get(), palette);
  fill(looks_.get(), looks);
}

void MaterialTextures::bind(const GlProgram& program, GLint unit) const {
  const auto texture = [&](const char* name, GLint at, const GlTexture& of) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(at));
    glBindTexture(GL_TEXTURE_2D, of.get());
    glUniform1i(glGetUniformLocation(program.get(), name), at);
  };
  texture("palette", unit, palette_);
  texture("looks", unit + 1, looks_);
}

}  // namespace runstone
