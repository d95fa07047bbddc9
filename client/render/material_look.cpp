#include "client/render/material_look.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace runstone {
namespace {

struct NamedLook {
  std::string_view part;  // of the name
  MaterialLook look;
};

using enum MaterialPattern;

/// The first row whose text is in the name decides.
constexpr std::array kLooks = {
    NamedLook{"lamp", {0.02F, 0.06F, 1.0F, none}}, NamedLook{"torch", {0.02F, 0.06F, 1.0F, none}},
    NamedLook{"lava", {0.10F, 0.30F, 0.9F, none}}, NamedLook{"glow", {0.02F, 0.06F, 0.9F, none}},
    NamedLook{"fire", {0.10F, 0.20F, 1.0F, none}}, NamedLook{"brick", {0.08F, 0.10F, 0, bricks}},
    NamedLook{"plank", {0.08F, 0.10F, 0, planks}}, NamedLook{"wood", {0.08F, 0.12F, 0, planks}},
    NamedLook{"leaves", {0.24F, 0.45F, 0, none}},  NamedLook{"grass", {0.16F, 0.26F, 0, none}},
    NamedLook{"tree", {0.10F, 0.24F, 0, none}},    NamedLook{"cobble", {0.16F, 0.30F, 0, none}},
    NamedLook{"gravel", {0.16F, 0.32F, 0, none}},  NamedLook{"stone", {0.10F, 0.16F, 0, none}},
    NamedLook{"dirt", {0.12F, 0.22F, 0, none}},    NamedLook{"sand", {0.07F, 0.13F, 0, none}},
    NamedLook{"snow", {0.03F, 0.05F, 0, none}},    NamedLook{"wool", {0.03F, 0.12F, 0, none}},
    NamedLook{"glass", {0.00F, 0.00F, 0, none}},
};

}  // namespace

MaterialLook material_look(const MaterialInfo& material) {
  const auto found = std::find_if(kLooks.begin(), kLooks.end(), [&](const NamedLook& row) {
    return material.name.find(row.part) != std::string::npos;
  });
  MaterialLook look = found == kLooks.end() ? MaterialLook{} : found->look;
  if (material.body == MaterialBody::liquid) look.pattern = liquid;
  return look;
}

}  // namespace runstone
