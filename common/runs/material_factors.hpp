// MaterialFactors: the digest's factors of recent materials. digest_material() divides twice, and a
// chunk may have tens of thousands of runs of a few materials.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/digest.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// Caches g(material) of both digest lanes for recent materials, direct-mapped by the low bits. All
/// zero is a valid start: slot 0 then holds g(kEmpty) = 0, and material 0 belongs to slot 0 alone.
class MaterialFactors {
 public:
  using Lanes = std::array<std::uint64_t, kDigestLanes>;
  const Lanes& of(Material material) {
    Slot& slot = slots_[material % kSlots];
    if (slot.material != material) {
      slot.material = material;
      for (int lane = 0; lane < kDigestLanes; ++lane) {
        slot.factor[static_cast<std::size_t>(lane)] = digest_material(lane, material);
      }
    }
    return slot.factor;
  }

 private:
  static constexpr std::size_t kSlots = 128;
  struct Slot {
    Material material = kEmpty;
    Lanes factor{};
  };
  std::array<Slot, kSlots> slots_{};
};

}  // namespace runstone
