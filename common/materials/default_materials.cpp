// The built-in table. Ids are frozen: worlds store them. New materials are appended.
#include "common/core/assert.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {
namespace {

struct PaletteRow {
  const char* name;
  std::uint32_t rgba;
  Visibility visibility = Visibility::opaque;
  MaterialBody body = MaterialBody::solid;
};

constexpr PaletteRow kPalette[] = {
    // Terrain. The first four have generation rules.
    {"grass", 0x6a9f3dff},
    {"sand", 0xe2cf98ff},
    {"dirt", 0x7d5a3cff},
    {"stone", 0x8b8d90ff},
    {"water", 0x2f74b5a8, Visibility::transparent, MaterialBody::liquid},
    {"snow", 0xf2f6faff},
    {"gravel", 0x87807aff},
    {"clay", 0xa7a9b6ff},
    // Building.
    {"glass", 0xcfe8f048, Visibility::transparent},
    {"planks", 0xb88a54ff},
    {"log", 0x5e4529ff},
    {"leaves", 0x3f7a2eff},
    {"brick", 0xa4503eff},
    {"cobble", 0x76777aff},
    {"stone_brick", 0x9c9c98ff},
    {"sandstone", 0xd3b97bff},
    {"slate", 0x4a5058ff},
    {"marble", 0xe4e1daff},
    {"thatch", 0xc2a24aff},
    {"copper", 0x56a08cff},
    {"gold", 0xf0c244ff},
    {"lamp", 0xffe7a3ff},
    // Wool: a small, even circle of colours.
    {"wool_white", 0xeeeae2ff},
    {"wool_grey", 0x7c7f86ff},
    {"wool_black", 0x26262bff},
    {"wool_red", 0xb8322fff},
    {"wool_orange", 0xe07f2bff},
    {"wool_yellow", 0xf1cb3bff},
    {"wool_green", 0x5b8c32ff},
    {"wool_cyan", 0x2f97a0ff},
    {"wool_blue", 0x3558a8ff},
    {"wool_violet", 0x7c3f9eff},
    {"wool_pink", 0xe58fb0ff},
    {"wool_brown", 0x6d4a2fff},
};

/// The rows of figure 7.21 in the thesis' order. The order decides which material covers which.
std::optional<GenerationRule> thesis_rule(std::string_view name) {
  if (name == "grass") return GenerationRule{{1, 50, 40, 0.007}, std::nullopt};
  if (name == "sand") return GenerationRule{{2, 50, 0, 0.007}, SurfaceRule{4, -1500, 300, 0.06}};
  if (name == "dirt") return GenerationRule{{3, 50, 20, 0.007}, std::nullopt};
  if (name == "stone") return GenerationRule{{4, 60, 0, 0.01}, std::nullopt};
  return std::nullopt;
}

MaterialTable make_default_table() {
  MaterialTable table;
  for (const PaletteRow& row : kPalette) {
    const std::array<std::uint8_t, 4> colour = {
        static_cast<std::uint8_t>(row.rgba >> 24), static_cast<std::uint8_t>(row.rgba >> 16),
        static_cast<std::uint8_t>(row.rgba >> 8), static_cast<std::uint8_t>(row.rgba)};
    const auto id = table.add({row.name, colour, row.visibility, thesis_rule(row.name), row.body});
    RUNSTONE_ASSERT(id.has_value());
  }
  return table;
}

}  // namespace

const MaterialTable& default_material_table() {
  static const MaterialTable table = make_default_table();
  return table;
}

}  // namespace runstone
