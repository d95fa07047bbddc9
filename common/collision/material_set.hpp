// MaterialSet: some of the materials, such as those that stop a body, or those in which it swims.
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

class MaterialSet {
 public:
  /// Makes the set of all materials but kEmpty.
  MaterialSet() = default;
  /// `has[i]` says whether material i is in the set. `has_unknown` says it for materials beyond
  /// the end, and for the voxels of chunks that are not known. It is true for materials that stop a
  /// body: a body must not fall out of a world that is still loading.
  MaterialSet(std::vector<bool> has, bool has_unknown)
      : has_(std::move(has)), has_unknown_(has_unknown) {}

  bool contains(Material material) const {
    if (material < has_.size()) return has_[material];
    return has_unknown_ && material != kEmpty;
  }
  bool has_unknown() const { return has_unknown_; }

 private:
  std::vector<bool> has_;
  bool has_unknown_ = true;
};

}  // namespace runstone
