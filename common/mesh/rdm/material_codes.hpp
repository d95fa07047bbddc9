// MaterialCodes: the materials of one chunk as short bit strings, so that rows of bits can be compared
// instead of materials. Numbers are given in the order in which materials come: opaque and transparent ones
// count apart, and all empty ones are 0.
//   bit 0         opaque
//   bits 1 ..     number within the class
//   bit kClear    transparent
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/mesh/visibility.hpp"

namespace runstone::rdm {

using Code = std::uint32_t;
inline constexpr Code kOpaqueBit = 1;
inline constexpr Code kTransparentBit = Code{1} << 20;

class MaterialCodes {
 public:
  MaterialCodes() : of_(kMaterialCountMax, 0) {}

  /// Forgets all numbers. O(materials seen).
  void clear() {
    for (const Material material : seen_) of_[material] = 0;
    seen_.clear();
    for (auto& numbered : of_class_) numbered.clear();
  }
  /// The code of a material of the chunk, given when it is first seen. O(1).
  Code number(Material material, const VisibilityTable& visibility) {
    const Code code = of_[material];
    return code != 0 ? code & ~kSeen : enter(material, visibility[material]);
  }
  /// What a material beyond the border means for faces of the chunk: bit 0 says that it hides any; a
  /// transparent material of the chunk has its number from bit 1 on, and bit 1 + clear_bits() set.
  Code border_code(Material material, const VisibilityTable& visibility) const {
    const Code code = of_[material];
    if ((code & kTransparentBit) != 0) return (code & (kTransparentBit - 2)) | Code{2} << clear_bits();
    return visibility[material] == Visibility::opaque ? 1 : 0;
  }

  bool has_transparent() const { return !of_class_[1].empty(); }
  /// Materials that are not empty.
  std::size_t solid_count() const { return of_class_[0].size() + of_class_[1].size(); }
  /// Bits that tell the numbers of a class apart.
  unsigned number_bits() const {
    std::size_t last = 0;
    for (const auto& numbered : of_class_) last |= numbered.empty() ? 0 : numbered.size() - 1;
    return static_cast<unsigned>(std::bit_width(last));
  }
  /// Those of a class, by number.
  const Material* materials(bool transparent) const { return of_class_[transparent ? 1 : 0].data(); }
  /// Bits that tell the transparent ones apart.
  unsigned clear_bits() const {
    return of_class_[1].empty() ? 0 : static_cast<unsigned>(std::bit_width(of_class_[1].size() - 1));
  }
  Material material(bool transparent, std::size_t number) const {
    return of_class_[transparent ? 1 : 0][number];
  }

 private:
  static constexpr Code kSeen = Code{1} << 31;

  Code enter(Material material, Visibility visibility) {
    Code code = 0;
    if (visibility != Visibility::empty) {
      const bool transparent = visibility == Visibility::transparent;
      std::vector<Material>& numbered = of_class_[transparent ? 1 : 0];
      code = (transparent ? kTransparentBit : kOpaqueBit) | static_cast<Code>(numbered.size()) << 1;
      numbered.push_back(material);
    }
    of_[material] = code | kSeen;
    seen_.push_back(material);
    return code;
  }

  std::vector<Code> of_;  // by material; 0: not seen yet
  std::vector<Material> seen_;
  std::array<std::vector<Material>, 2> of_class_;  // opaque and transparent, by number
};

}  // namespace runstone::rdm
