// SolidMaterials: which materials stop a body.
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

class SolidMaterials {
 public:
  /// Makes a table in which every material but kEmpty is solid.
  SolidMaterials() = default;
  /// `is_solid[i]` is that of material i. Materials behind the end are solid: a body must not fall
  /// through a voxel of a material that the caller does not know yet.
  explicit SolidMaterials(std::vector<bool> is_solid) : is_solid_(std::move(is_solid)) {}

  bool contains(Material material) const {
    if (material < is_solid_.size()) return is_solid_[material];
    return material != kEmpty;
  }

 private:
  std::vector<bool> is_solid_;
};

}  // namespace runstone
