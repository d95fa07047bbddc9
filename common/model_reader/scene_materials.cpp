#include "common/model_reader/scene_materials.hpp"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "common/models/printable_line.hpp"

namespace runstone {
namespace {

bool is_gltf_scene(const SceneRules& rules) {
  return rules.format == ModelFormat::gltf || rules.format == ModelFormat::glb;
}

std::string texture_path(const aiMaterial& from) {
  aiString path;
  if (from.GetTexture(aiTextureType_DIFFUSE, 0, &path) != aiReturn_SUCCESS) return {};
  return {path.C_Str(), path.length};
}

TextureReader::Alpha alpha_of(const aiMaterial& from, const SceneRules& rules) {
  if (!is_gltf_scene(rules)) return {};
  aiString mode;
  if (from.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != aiReturn_SUCCESS) return {};
  const std::string_view name(mode.C_Str(), mode.length);
  if (name == "BLEND") return {};
  if (name != "MASK") return {AlphaRule::opaque, 0};
  float cutoff = 0.5F;
  from.Get(AI_MATKEY_GLTF_ALPHACUTOFF, cutoff);
  return {AlphaRule::mask, unit_byte(cutoff)};
}

}  // namespace

std::uint8_t unit_byte(float value) {
  if (!(value > 0)) return 0;
  return static_cast<std::uint8_t>(std::lround(std::min(value, 1.0F) * 255));
}

std::uint8_t srgb_byte(float linear) {
  if (!(linear > 0)) return 0;
  const float x = std::min(linear, 1.0F);
  return unit_byte(x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F);
}

SceneMaterials::SceneMaterials(const aiScene& scene, const SceneRules& rules,
                               const ModelFolder& folder, Model& model, ReaderNotices& notices)
    : scene_(scene),
      rules_(rules),
      model_(model),
      notices_(notices),
      textures_(folder, model.textures, notices) {
  // STL and PLY have no colours of materials, so Assimp adds a grey one. An .obj without materials
  // gets one with the name for it.
  const bool has_own = rules.format == ModelFormat::obj || is_gltf_scene(rules);
  for (std::uint32_t i = 0; i < scene.mNumMaterials; ++i) {
    const aiMaterial& material = *scene.mMaterials[i];
    const bool is_added =
        !has_own || std::string_view(material.GetName().C_Str()) == AI_DEFAULT_MATERIAL_NAME;
    if (!is_added || !texture_path(material).empty()) are_defaults_ = false;
  }
}

Result<std::uint32_t, std::string> SceneMaterials::number_of(std::uint32_t scene_number) {
  if (const auto known = numbers_.find(scene_number); known != numbers_.end()) return known->second;
  if (scene_number >= scene_.mNumMaterials)
    return failure(std::string("a mesh names a material that does not exist"));
  if (model_.materials.size() >= kModelMaterialsMax)
    return failure(std::string("the file has more than 65,535 materials"));
  auto made = material_of(*scene_.mMaterials[scene_number]);
  if (!made) return failure(made.error());
  model_.materials.push_back(*std::move(made));
  const auto number = static_cast<std::uint32_t>(model_.materials.size() - 1);
  numbers_[scene_number] = number;
  return number;
}

std::uint32_t SceneMaterials::place_set_of(std::uint32_t scene_number) const {
  int set = 0;
  if (scene_number < scene_.mNumMaterials)
    scene_.mMaterials[scene_number]->Get(AI_MATKEY_UVWSRC(aiTextureType_DIFFUSE, 0), set);
  return set > 0 && set < AI_MAX_NUMBER_OF_TEXTURECOORDS ? static_cast<std::uint32_t>(set) : 0;
}

Result<ModelMaterial, std::string> SceneMaterials::material_of(const aiMaterial& from) {
  ModelMaterial material;
  const aiString name = from.GetName();
  material.name = printable_line({name.C_Str(), name.length}, kModelNameBytesMax);
  const TextureReader::Alpha alpha = alpha_of(from, rules_);
  const auto texture = texture_of(from, alpha);
  if (!texture) return failure(texture.error());
  material.texture = *texture;

  aiColor4D colour(1, 1, 1, 1);
  const bool is_known = from.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS;
  if (is_gltf_scene(rules_)) {
    material.colour = {srgb_byte(colour.r), srgb_byte(colour.g), srgb_byte(colour.b),
                       unit_byte(colour.a)};
    if (alpha.rule == AlphaRule::opaque) material.colour[3] = 255;
    if (alpha.rule == AlphaRule::mask && !material.texture)
      material.colour[3] = material.colour[3] >= alpha.cutoff ? 255 : 0;
    return material;
  }
  // Exporters of .obj write a colour beside a texture that is not meant to darken it.
  const bool is_plain = is_known && !material.texture && !rules_.lacks_materials &&
                        material.name != AI_DEFAULT_MATERIAL_NAME;
  if (is_plain)
    material.colour = {unit_byte(colour.r), unit_byte(colour.g), unit_byte(colour.b), 255};
  float opacity = 1;
  from.Get(AI_MATKEY_OPACITY, opacity);
  material.colour[3] = unit_byte(opacity);
  return material;
}

Result<std::optional<std::uint32_t>, std::string> SceneMaterials::texture_of(
    const aiMaterial& from, TextureReader::Alpha alpha) {
  using Number = std::optional<std::uint32_t>;
  const std::string path = texture_path(from);
  if (path.empty()) return Number();
  aiUVTransform transform;
  if (is_gltf_scene(rules_) &&
      from.Get(AI_MATKEY_UVTRANSFORM(aiTextureType_DIFFUSE, 0), transform) == aiReturn_SUCCESS)
    notices_.add("transforms of texture places are left out");
  const aiTexture* const embedded = scene_.GetEmbeddedTexture(path.c_str());
  if (embedded == nullptr) return textures_.from_file(path, alpha);
  // A height of 0 means the bytes of an image file. The formats that are read have no other kind.
  if (embedded->mHeight != 0) return Number();
  return textures_.from_bytes(
      path, {reinterpret_cast<const std::uint8_t*>(embedded->pcData), embedded->mWidth}, alpha);
}

}  // namespace runstone
