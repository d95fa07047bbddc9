// The words of the TOML form of a material table, in the order of the values. Internal to this
// module.
#pragma once
#include <iterator>

#include "common/core/material_look.hpp"

namespace runstone {

inline constexpr const char* kVisibilityNames[] = {"empty", "opaque", "transparent"};
inline constexpr const char* kBodyNames[] = {"solid", "liquid", "passable"};
inline constexpr const char* kPatternNames[] = {"none", "planks", "bricks", "tiles",  "cobble",
                                                "bark", "weave",  "blades", "flower", "foliage"};
static_assert(std::size(kPatternNames) == kMaterialPatterns);

}  // namespace runstone
