#include "client/render/terrain_programs.hpp"

#include "client/render/terrain_glsl.hpp"

namespace runstone {
namespace {

std::string definitions_of(Quality quality, bool is_transparent, unsigned variant) {
  std::string out;
  const auto has = [variant](unsigned bit) { return (variant & bit) != 0; };
  if (is_transparent) out += kLiquidVariant;
  if (quality != Quality::low) out += "#define RUNSTONE_DEPTH\n";
  if (quality != Quality::low && !has(TerrainVariant::kTile)) out += "#define RUNSTONE_SHADOWS\n";
  if (has(TerrainVariant::kTile)) out += "#define RUNSTONE_TILE\n";
  if (has(TerrainVariant::kInField)) out += "#define RUNSTONE_FIELD\n";
  if (has(TerrainVariant::kFine)) out += "#define RUNSTONE_FINE\n";
  if (has(TerrainVariant::kInFog)) out += "#define RUNSTONE_FOG\n";
  if (has(TerrainVariant::kFade)) out += "#define RUNSTONE_FADE\n";
  if (has(TerrainVariant::kGlossy)) out += "#define RUNSTONE_GLOSSY\n";
  const bool is_textured = has(TerrainVariant::kTextured);
  return texture_definitions(is_textured, has(TerrainVariant::kHoles),
                             is_textured && is_transparent) +
         out;
}

}  // namespace

std::string texture_definitions(bool is_textured, bool has_holes, bool has_all_holes) {
  std::string out;
  if (is_textured) out += "#define RUNSTONE_TEXTURES\n";
  if (has_holes) out += "#define RUNSTONE_HOLES\n";
  if (has_all_holes) out += "#define RUNSTONE_ALL_HOLES\n";
  return out;
}

TerrainProgram& TerrainPrograms::of(Quality quality, bool is_transparent, unsigned variant) {
  TerrainProgram& out =
      programs_[static_cast<std::size_t>(quality)][is_transparent ? 1 : 0][variant];
  if (!out.gl) {
    const char* fragment = is_transparent ? kTransparentFragmentShader : kTerrainFragmentShader;
    const std::string definitions = definitions_of(quality, is_transparent, variant);
    out.gl = link_program(is_transparent ? "transparent" : "terrain",
                          (definitions + kTerrainVertexShader).c_str(),
                          (definitions + fragment).c_str());
    out.origin = glGetUniformLocation(out.gl.get(), "origin");
    out.pattern = glGetUniformLocation(out.gl.get(), "pattern");
    out.scale = glGetUniformLocation(out.gl.get(), "scale");
    out.edge = glGetUniformLocation(out.gl.get(), "edge");
    out.drawn = glGetUniformLocation(out.gl.get(), "drawn");
  }
  return out;
}

}  // namespace runstone
