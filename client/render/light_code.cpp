#include "client/render/light_code.hpp"

#include <algorithm>
#include <cmath>

#include "common/materials/default_look.hpp"
#include "common/materials/foliage.hpp"

namespace runstone {
namespace {

LightPass light_pass(const MaterialInfo& material) {
  if (material.body == MaterialBody::liquid) return LightPass::liquid;
  // Leaves are often opaque to the mesher, but a wood is not as dark as a cave.
  if (is_foliage(material)) return LightPass::leaves;
  // A shape hides no face of the cubes beside it, which would be black without light.
  if (!material.shape.is_cube()) return LightPass::open;
  return material.visibility == Visibility::opaque ? LightPass::opaque : LightPass::open;
}

}  // namespace

LightCode light_code(const MaterialInfo& material) {
  const float emission = static_cast<float>(look_of(material).emission) / kLookShareMax;
  const auto linear = [&](std::size_t channel) {
    return std::pow(static_cast<float>(material.colour[channel]) / 255.0F, 2.2F);
  };
  // Bright light looks paler than the material that gives it off.
  constexpr float kPale = 0.2F;
  const float brightest = std::max({linear(0), linear(1), linear(2)});
  const auto level = [&](std::size_t channel) {
    const float light = emission * std::lerp(linear(channel), brightest, kPale);
    return static_cast<unsigned>(std::lround(15 * std::sqrt(light)));
  };
  return light_code(light_pass(material), level(0), level(1), level(2));
}

LightCodes light_codes(const MaterialTable& materials) {
  LightCodes out;
  out.reserve(materials.size());
  for (const MaterialInfo& row : materials.rows()) out.push_back(light_code(row));
  return out;
}

}  // namespace runstone
