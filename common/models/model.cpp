#include "common/models/model.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/text.hpp"

namespace runstone {
namespace {

Result<void> check_counts(const Model& m) {
  if (m.positions.empty()) return fail(ErrorCode::bad_value, "the model has no vertex");
  if (m.positions.size() > kModelVerticesMax)
    return fail(ErrorCode::limit_exceeded, "the model has more than 100,000,000 vertices");
  if (m.triangles.size() > kModelTrianglesMax)
    return fail(ErrorCode::limit_exceeded, "the model has more than 100,000,000 triangles");
  if (m.materials.size() > kModelMaterialsMax)
    return fail(ErrorCode::limit_exceeded, "the model has more than 65,535 materials");
  if (m.textures.size() > kModelTexturesMax)
    return fail(ErrorCode::limit_exceeded, "the model has more than 1,024 textures");
  if (!m.texture_places.empty() && m.texture_places.size() != m.positions.size())
    return fail(ErrorCode::bad_value, "a place in the texture is missing");
  if (!m.colours.empty() && m.colours.size() != m.positions.size())
    return fail(ErrorCode::bad_value, "the colour of a vertex is missing");
  if (!m.material_of.empty() && m.material_of.size() != m.triangles.size())
    return fail(ErrorCode::bad_value, "the material of a triangle is missing");
  return {};
}

Result<void> check_textures(const Model& m) {
  std::size_t bytes = 0;
  for (const ModelTexture& texture : m.textures) {
    if (texture.width == 0 || texture.height == 0 || texture.width > kModelTextureSideMax ||
        texture.height > kModelTextureSideMax)
      return fail(ErrorCode::limit_exceeded, "a texture is not 1 .. 16,384 texels a side");
    if (texture.texels.size() != std::size_t{4} * texture.width * texture.height)
      return fail(ErrorCode::bad_value, "a texture lacks texels");
    bytes += texture.texels.size();
    if (bytes > kModelTextureBytesMax)
      return fail(ErrorCode::limit_exceeded, "the textures take more than 512 MiB");
  }
  return {};
}

}  // namespace

Result<void> validate(const Model& m) {
  if (auto ok = check_counts(m); !ok) return ok;
  const auto is_finite = [](const auto& place) {
    return std::all_of(place.begin(), place.end(), [](float v) { return std::isfinite(v); });
  };
  if (!std::all_of(m.positions.begin(), m.positions.end(), is_finite))
    return fail(ErrorCode::bad_value, "a vertex is not finite");
  if (!std::all_of(m.texture_places.begin(), m.texture_places.end(), is_finite))
    return fail(ErrorCode::bad_value, "a place in the texture is not finite");
  for (const auto& triangle : m.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= m.positions.size())
        return fail(ErrorCode::bad_value, "a triangle names a vertex that does not exist");
    }
  }
  for (const std::uint32_t material : m.material_of) {
    if (material >= m.materials.size())
      return fail(ErrorCode::bad_value, "a triangle names a material that does not exist");
  }
  if (auto ok = check_textures(m); !ok) return ok;
  for (const ModelMaterial& material : m.materials) {
    if (material.name.size() > kModelNameBytesMax || !is_printable_utf8(material.name))
      return fail(ErrorCode::bad_value, "the name of a material is no text of 0 .. 64 bytes");
    if (material.texture && *material.texture >= m.textures.size())
      return fail(ErrorCode::bad_value, "a material names a texture that does not exist");
  }
  if (m.metres_per_unit && !(*m.metres_per_unit > 0 && std::isfinite(*m.metres_per_unit)))
    return fail(ErrorCode::bad_value, "the length of a unit is not above 0");
  return {};
}

}  // namespace runstone
