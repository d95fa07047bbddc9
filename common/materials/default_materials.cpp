// The built-in table. Ids are frozen: worlds store them. New materials are appended.
#include "common/core/assert.hpp"
#include "common/materials/material_table.hpp"
#include "common/shapes/shape_states.hpp"

namespace runstone {
namespace {

using enum MaterialPattern;

struct PaletteRow {
  const char* name;
  std::uint32_t rgba;
  MaterialLook look;  // variation, grain, roughness, emission, pattern
  Visibility visibility = Visibility::opaque;
  MaterialBody body = MaterialBody::solid;
};

constexpr MaterialLook kWool{3, 12, 100, 0, weave};

constexpr PaletteRow kPalette[] = {
    // Terrain. The first four have generation rules.
    {"grass", 0x6a9f3dff, {16, 26, 100, 0, none}},
    {"sand", 0xe2cf98ff, {7, 13, 100, 0, none}},
    {"dirt", 0x7d5a3cff, {12, 22, 100, 0, none}},
    {"stone", 0x8b8d90ff, {10, 16, 95, 0, none}},
    {"water", 0x2f74b5a8, {4, 4, 5, 0, none}, Visibility::transparent, MaterialBody::liquid},
    {"snow", 0xf2f6faff, {3, 5, 80, 0, none}},
    {"gravel", 0x87807aff, {16, 32, 100, 0, none}},
    {"clay", 0xa7a9b6ff, {5, 8, 90, 0, none}},
    // Building.
    {"glass", 0xcfe8f048, {0, 0, 5, 0, none}, Visibility::transparent},
    {"planks", 0xb88a54ff, {8, 10, 75, 0, planks}},
    {"log", 0x5e4529ff, {10, 16, 95, 0, bark}},
    {"leaves", 0x3f7a2eff, {24, 45, 100, 0, none}},
    {"brick", 0xa4503eff, {8, 10, 85, 0, bricks}},
    {"cobble", 0x76777aff, {10, 16, 95, 0, cobble}},
    {"stone_brick", 0x9c9c98ff, {7, 10, 80, 0, bricks}},
    {"sandstone", 0xd3b97bff, {6, 12, 90, 0, none}},
    {"slate", 0x4a5058ff, {8, 10, 50, 0, tiles}},
    {"marble", 0xe4e1daff, {4, 6, 20, 0, tiles}},
    {"thatch", 0xc2a24aff, {10, 26, 100, 0, weave}},
    {"copper", 0x56a08cff, {5, 6, 35, 0, tiles}},
    {"gold", 0xf0c244ff, {4, 4, 20, 0, tiles}},
    {"lamp", 0xffe7a3ff, {2, 6, 60, 100, none}},
    // Wool: a small, even circle of colours.
    {"wool_white", 0xeeeae2ff, kWool},
    {"wool_grey", 0x7c7f86ff, kWool},
    {"wool_black", 0x26262bff, kWool},
    {"wool_red", 0xb8322fff, kWool},
    {"wool_orange", 0xe07f2bff, kWool},
    {"wool_yellow", 0xf1cb3bff, kWool},
    {"wool_green", 0x5b8c32ff, kWool},
    {"wool_cyan", 0x2f97a0ff, kWool},
    {"wool_blue", 0x3558a8ff, kWool},
    {"wool_violet", 0x7c3f9eff, kWool},
    {"wool_pink", 0xe58fb0ff, kWool},
    {"wool_brown", 0x6d4a2fff, kWool},
};

/// The materials of trees and forest ground in a landscape, besides the materials above.
constexpr PaletteRow kGrowth[] = {
    {"forest_floor", 0x5c7434ff, {18, 32, 100, 0, none}},
    {"pine_leaves", 0x2f5a3cff, {22, 42, 100, 0, none}},
    {"birch_log", 0xd8d4c6ff, {8, 20, 95, 0, bark}},
    {"birch_leaves", 0x79a544ff, {22, 42, 100, 0, none}},
};

struct PlantRow {
  const char* name;
  std::uint32_t rgba;
  unsigned height, inset;  // sixteenths of a voxel
  MaterialPattern pattern;
};

constexpr PlantRow kPlants[] = {
    {"tall_grass", 0x76aa45ff, 14, 1, blades}, {"fern", 0x4f8a3cff, 12, 1, blades},
    {"bush", 0x4a7f33ff, 15, 1, foliage},      {"reeds", 0x9cab5cff, 16, 3, blades},
    {"poppy", 0xcf3b30ff, 12, 3, flower},      {"dandelion", 0xf0cb3aff, 10, 4, flower},
    {"cornflower", 0x5674d2ff, 12, 3, flower},
};

std::array<std::uint8_t, 4> colour_of(std::uint32_t rgba) {
  return {static_cast<std::uint8_t>(rgba >> 24), static_cast<std::uint8_t>(rgba >> 16),
          static_cast<std::uint8_t>(rgba >> 8), static_cast<std::uint8_t>(rgba)};
}

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
    const auto id = table.add(
        {row.name, colour_of(row.rgba), row.visibility, thesis_rule(row.name), row.body, row.look});
    RUNSTONE_ASSERT(id.has_value());
  }
  return table;
}

MaterialTable make_landscape_table() {
  MaterialTable table = make_default_table();
  for (const PaletteRow& row : kGrowth) {
    const auto id = table.add(
        {row.name, colour_of(row.rgba), row.visibility, std::nullopt, row.body, row.look});
    RUNSTONE_ASSERT(id.has_value());
  }
  for (const PlantRow& row : kPlants) {
    const auto id = table.add({row.name, colour_of(row.rgba), Visibility::opaque, std::nullopt,
                               MaterialBody::passable, MaterialLook{14, 20, 100, 0, row.pattern},
                               plant_shape(row.height, row.inset)});
    RUNSTONE_ASSERT(id.has_value());
  }
  return table;
}

}  // namespace

const MaterialTable& default_material_table() {
  static const MaterialTable table = make_default_table();
  return table;
}

const MaterialTable& landscape_material_table() {
  static const MaterialTable table = make_landscape_table();
  return table;
}

}  // namespace runstone
