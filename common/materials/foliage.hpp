// Foliage: materials through which light passes, although they may hide the faces behind them.
#pragma once
#include <string>

#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns true for leaves. No field of a row says that light passes, so the name decides.
inline bool is_foliage(const MaterialInfo& material) {
  return material.name.find("leaves") != std::string::npos;
}

}  // namespace runstone
