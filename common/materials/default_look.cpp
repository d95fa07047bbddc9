#include "common/materials/default_look.hpp"

#include <algorithm>
#include <array>

#include "common/materials/look_on_shape.hpp"

namespace runstone {
namespace {

struct WordLook {
  std::string_view word;
  MaterialLook look;
};

using enum MaterialPattern;

/// The first row whose word is in the name decides, so specific words precede general ones.
/// Columns: variation, grain, roughness, emission, pattern.
constexpr std::array kWords = {
    // Light. A block of glowing ore or glass is a lamp, too.
    WordLook{"lamp", {2, 6, 60, 100, none}},
    WordLook{"lantern", {2, 6, 60, 100, none}},
    WordLook{"torch", {2, 6, 100, 100, none}},
    WordLook{"glow", {2, 6, 60, 90, none}},
    WordLook{"lava", {10, 30, 100, 90, none}},
    WordLook{"magma", {10, 30, 100, 60, cobble}},
    WordLook{"fire", {10, 20, 100, 100, none}},
    WordLook{"flame", {10, 20, 100, 100, none}},
    // Smooth.
    WordLook{"glass", {0, 0, 5, 0, none}},
    WordLook{"pane", {0, 0, 5, 0, none}},
    WordLook{"obsidian", {6, 10, 15, 0, none}},
    WordLook{"marble", {4, 6, 20, 0, tiles}},
    WordLook{"gold_block", {4, 4, 20, 0, tiles}},
    WordLook{"goldblock", {4, 4, 20, 0, tiles}},
    WordLook{"steelblock", {4, 4, 25, 0, tiles}},
    WordLook{"iron_block", {4, 4, 25, 0, tiles}},
    WordLook{"copperblock", {4, 4, 30, 0, tiles}},
    WordLook{"bronzeblock", {4, 4, 30, 0, tiles}},
    WordLook{"tinblock", {4, 4, 30, 0, tiles}},
    WordLook{"diamondblock", {4, 4, 5, 0, tiles}},
    // Worked stone, wood and cloth.
    WordLook{"brick", {8, 10, 85, 0, bricks}},
    WordLook{"stone_block", {6, 10, 75, 0, tiles}},
    WordLook{"sandstone_block", {5, 10, 80, 0, tiles}},
    WordLook{"plank", {8, 10, 75, 0, planks}},
    WordLook{"wood", {8, 12, 75, 0, planks}},
    WordLook{"bookshelf", {8, 12, 75, 0, planks}},
    WordLook{"chest", {6, 10, 70, 0, planks}},
    WordLook{"wool", {3, 12, 100, 0, weave}},
    WordLook{"carpet", {3, 12, 100, 0, weave}},
    WordLook{"thatch", {10, 26, 100, 0, weave}},
    WordLook{"straw", {10, 26, 100, 0, weave}},
    WordLook{"hay", {10, 26, 100, 0, weave}},
    WordLook{"stem", {10, 16, 95, 0, bark}},
    // Plants. "with_grass" and the like are the upper side of earth.
    WordLook{"leaves", {24, 45, 100, 0, none}},
    WordLook{"needles", {24, 45, 100, 0, none}},
    WordLook{"bush", {24, 45, 100, 0, foliage}},
    WordLook{"shrub", {24, 45, 100, 0, foliage}},
    WordLook{"sapling", {24, 45, 100, 0, foliage}},
    WordLook{"flower", {14, 20, 100, 0, flower}},
    WordLook{"poppy", {14, 20, 100, 0, flower}},
    WordLook{"dandelion", {14, 20, 100, 0, flower}},
    WordLook{"tulip", {14, 20, 100, 0, flower}},
    WordLook{"daisy", {14, 20, 100, 0, flower}},
    WordLook{"orchid", {14, 20, 100, 0, flower}},
    WordLook{"allium", {14, 20, 100, 0, flower}},
    WordLook{"azure_bluet", {14, 20, 100, 0, flower}},
    WordLook{"lily_of_the_valley", {14, 20, 100, 0, flower}},
    WordLook{"_rose", {14, 20, 100, 0, flower}},
    WordLook{"fern", {16, 26, 100, 0, blades}},
    WordLook{"reed", {16, 26, 100, 0, blades}},
    WordLook{"papyrus", {16, 26, 100, 0, blades}},
    WordLook{"sugar_cane", {16, 26, 100, 0, blades}},
    WordLook{"wheat", {16, 26, 100, 0, blades}},
    WordLook{"grass", {16, 26, 100, 0, blades}},
    WordLook{"moss", {16, 30, 100, 0, none}},
    WordLook{"litter", {18, 32, 100, 0, none}},
    WordLook{"tree", {10, 16, 95, 0, bark}},
    WordLook{"trunk", {10, 16, 95, 0, bark}},
    WordLook{"log", {10, 16, 95, 0, bark}},
    WordLook{"cactus", {6, 14, 90, 0, bark}},
    // Ground.
    WordLook{"cobble", {10, 16, 95, 0, cobble}},
    WordLook{"gravel", {16, 32, 100, 0, none}},
    WordLook{"snow", {3, 5, 80, 0, none}},
    WordLook{"ice", {3, 4, 10, 0, none}},
    WordLook{"sand", {7, 13, 100, 0, none}},
    WordLook{"stone", {10, 16, 95, 0, none}},
    WordLook{"slate", {8, 12, 60, 0, none}},
    WordLook{"dirt", {12, 22, 100, 0, none}},
    WordLook{"soil", {12, 22, 100, 0, none}},
    WordLook{"clay", {5, 8, 90, 0, none}},
    // Metal and crystal, as far as it is no ore in stone.
    WordLook{"mese", {4, 6, 20, 10, none}},
    WordLook{"gold", {4, 4, 20, 0, none}},
    WordLook{"steel", {4, 4, 25, 0, none}},
    WordLook{"iron", {4, 4, 25, 0, none}},
    WordLook{"copper", {5, 6, 30, 0, none}},
    WordLook{"bronze", {5, 6, 30, 0, none}},
    WordLook{"diamond", {4, 4, 5, 0, none}},
};

}  // namespace

MaterialLook default_look(std::string_view name, MaterialBody body, const Shape& shape) {
  const auto found = std::find_if(kWords.begin(), kWords.end(), [&](const WordLook& row) {
    return name.find(row.word) != std::string_view::npos;
  });
  MaterialLook look = found == kWords.end() ? MaterialLook{} : found->look;
  if (body == MaterialBody::liquid) look.pattern = none;
  return look_on_shape(look, shape);
}

MaterialLook look_of(const MaterialInfo& material) {
  return material.look ? *material.look
                       : default_look(material.name, material.body, material.shape);
}

}  // namespace runstone
