// DrawnTextures: the textures of a world that are drawn. Immutable.
#pragma once
#include <memory>
#include <vector>

#include "client/render/texture_levels.hpp"
#include "common/textures/texture_table.hpp"

namespace runstone {

struct DrawnTextures {
  TextureTablePtr table;
  /// The pictures by their index in the table, at most one for each. Null: the picture is not here,
  /// and the sides that use it show the look of their material.
  std::vector<TextureLevelsPtr> pictures;
};
/// Null: no textures are drawn.
using DrawnTexturesPtr = std::shared_ptr<const DrawnTextures>;

}  // namespace runstone
