// WirePalette: the materials of a run list in ascending order, and the index of each. Internal to
// the chunk codec. It reuses its memory from call to call.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/runs/run_list.hpp"

namespace runstone {

class WirePalette {
 public:
  /// Finds the materials of the runs. Cost: O(runs + largest id / 64).
  template <class Runs>
  void find(const Runs& runs) {
    Material highest = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) highest = std::max(highest, runs.material(i));
    // All memory is allocated before a bit is set, so that bits are zero again if there is none.
    index_of_.resize(std::max<std::size_t>(index_of_.size(), highest + 1u));
    ids_.clear();
    ids_.reserve(std::min<std::size_t>(runs.size(), highest + 1u));
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const Material id = runs.material(i);
      present_[id / 64u] |= 1ULL << (id % 64u);
    }
    for (std::size_t word = 0; word <= highest / 64u; ++word) {
      for (std::uint64_t bits = present_[word]; bits != 0; bits &= bits - 1) {
        const auto id =
            static_cast<Material>(word * 64 + static_cast<unsigned>(std::countr_zero(bits)));
        index_of_[id] = static_cast<std::uint16_t>(ids_.size());
        ids_.push_back(id);
      }
      present_[word] = 0;
    }
  }

  const std::vector<Material>& ids() const { return ids_; }
  /// Returns the index of a material. Requires a material of the runs that find() got last.
  std::uint16_t index_of(Material id) const { return index_of_[id]; }

 private:
  std::array<std::uint64_t, 1024> present_{};  // one bit per material id; all zero between calls
  std::vector<std::uint16_t> index_of_;        // by material id; valid for ids()
  std::vector<Material> ids_;
};

}  // namespace runstone
