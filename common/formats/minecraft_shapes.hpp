// The shapes of Minecraft's blocks: dimensions by name and states, rounded to sixteenths. They are
// facts about the blocks, written for this project; no model or art of the game is used.
#pragma once
#include <optional>

#include "common/core/shape.hpp"
#include "common/formats/format.hpp"

namespace runstone {

/// Returns the shape of a block, or nullopt if it is a cube, a liquid or air. Missing states have
/// their defaults, as in the game. Blocks of other namespaces have the shape of a block of the game
/// whose name fits the same rule: "mod:fir_stairs" are stairs. check_shape() succeeds for each
/// result. Cost: O(rules + bytes).
std::optional<Shape> shape_of_minecraft_block(const ForeignBlock& block);

}  // namespace runstone
