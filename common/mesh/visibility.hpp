// VisibilityTable: the visibility of each material as a flat array, for inner loops.
// A face of material a towards material b is drawn if a is not empty, b is not opaque and a != b.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/ids.hpp"
#include "common/core/visibility.hpp"

namespace runstone {

class VisibilityTable {
 public:
  /// Entry i of `materials` is the visibility of material i. Ids without an entry are opaque, and
  /// kEmpty is always empty. Requires at most kMaterialCountMax entries;
  /// visibility_table() (rdm/checked_mesh.hpp) takes any number.
  explicit VisibilityTable(std::span<const Visibility> materials)
      : visibility_(kMaterialCountMax, Visibility::opaque) {
    RUNSTONE_ASSERT(materials.size() <= kMaterialCountMax);
    std::copy(materials.begin(), materials.end(), visibility_.begin());
    visibility_[kEmpty] = Visibility::empty;
  }

  Visibility operator[](Material id) const { return visibility_[id]; }
  /// Returns kMaterialCountMax entries by id, for inner loops that write bytes.
  const Visibility* data() const { return visibility_.data(); }
  /// Returns true if the face of a voxel of `material` towards a voxel of `neighbour` is drawn.
  bool face_drawn(Material material, Material neighbour) const {
    return visibility_[material] != Visibility::empty &&
           visibility_[neighbour] != Visibility::opaque && material != neighbour;
  }

 private:
  std::vector<Visibility> visibility_;
};

}  // namespace runstone
