// VisibilityTable: the one fact a mesher needs of a material, as a flat array for inner loops.
// A face of material a towards b is drawn iff a is not empty, b is not opaque and a != b.
#pragma once
#include <vector>

#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

class VisibilityTable {
 public:
  explicit VisibilityTable(const MaterialTable& materials)
      : of_(kMaterialCountMax, Visibility::opaque) {
    for (std::size_t id = 0; id < materials.size(); ++id) {
      of_[id] = materials[static_cast<Material>(id)].visibility;
    }
    of_[kEmpty] = Visibility::empty;
  }
  /// Ids beyond the table count as opaque.
  Visibility operator[](Material id) const { return of_[id]; }
  /// By id, kMaterialCountMax of them: for inner loops that write bytes.
  const Visibility* data() const { return of_.data(); }
  bool face_drawn(Material of, Material towards) const {
    return of_[of] != Visibility::empty && of_[towards] != Visibility::opaque && of != towards;
  }

 private:
  std::vector<Visibility> of_;
};

}  // namespace runstone
