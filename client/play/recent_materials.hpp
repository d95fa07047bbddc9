// RecentMaterials: the materials that the player used last, newest first. One thread.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

class RecentMaterials {
 public:
  static constexpr std::size_t kKeptMax = 12;

  /// Puts a material to the front. Does nothing for kEmpty.
  void note(Material material) {
    if (material == kEmpty) return;
    std::erase(all_, material);
    all_.insert(all_.begin(), material);
    if (all_.size() > kKeptMax) all_.pop_back();
  }
  void clear() { all_.clear(); }
  const std::vector<Material>& all() const { return all_; }

 private:
  std::vector<Material> all_;
};

}  // namespace runstone
