// ChunkPalette: the materials of one chunk as small numbers, so that a layer of them is a few cache lines and
// 64 voxels can be compared at once. Numbers are given in the order in which materials come: opaque and
// transparent ones count apart, and all empty ones are 0.
//   opaque        1, 2, ...
//   transparent   kTransparentBit + 0, 1, ...
// A chunk with few materials has its codes in a byte, kTransparentBit becoming the highest bit of it.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/mesh/visibility.hpp"

namespace runstone::rdm {

using PaletteIndex = std::uint32_t;
using BytePaletteIndex = std::uint8_t;
inline constexpr PaletteIndex kTransparentBit = PaletteIndex{1} << 31;

/// A code in the form C. BytePaletteIndex requires ChunkPalette::fit_bytes().
template <class C>
constexpr C code_as(PaletteIndex code) {
  return static_cast<C>(sizeof(C) == 1 ? code | code >> 24 : code);
}
/// What code_as() was given.
constexpr PaletteIndex whole_code(PaletteIndex code) { return code; }
constexpr PaletteIndex whole_code(BytePaletteIndex code) {
  return (code & 0x7fu) | PaletteIndex{code} >> 7 << 31;
}

class ChunkPalette {
 public:
  ChunkPalette() : of_(kMaterialCountMax, kUnseen) {}

  /// Forgets all numbers. O(materials seen).
  void clear() {
    for (const Material material : seen_) of_[material] = kUnseen;
    seen_.clear();
    for (auto& numbered : of_class_) numbered.clear();
  }
  /// The code of a material of the chunk, given when it is first seen. O(1).
  PaletteIndex number(Material material, const VisibilityTable& visibility) {
    const PaletteIndex code = of_[material];
    return code != kUnseen ? code : enter(material, visibility[material]);
  }
  /// The code of a material if it is a transparent one of the chunk, else 0.
  PaletteIndex transparent_code(Material material) const {
    const PaletteIndex code = of_[material];
    return code != kUnseen && (code & kTransparentBit) != 0 ? code : 0;
  }

  std::size_t transparent_count() const { return of_class_[1].size(); }
  bool has_transparent() const { return transparent_count() != 0; }
  /// Materials that are not empty.
  std::size_t solid_count() const { return of_class_[0].size() + of_class_[1].size(); }
  /// The material, if there is but one that is not empty.
  Material single() const { return of_class_[has_transparent() ? 1 : 0].front(); }

  /// Whether all codes fit into a byte each.
  bool fit_bytes() const { return of_class_[0].size() <= 127 && of_class_[1].size() <= 128; }
  /// The material of a code that was given, 0 apart.
  Material material(BytePaletteIndex code) const { return of_byte_[code]; }
  Material material(PaletteIndex code) const {
    return (code & kTransparentBit) != 0 ? of_class_[1][code ^ kTransparentBit]
                                         : of_class_[0][code - 1];
  }

 private:
  static constexpr PaletteIndex kUnseen = std::numeric_limits<PaletteIndex>::max();

  PaletteIndex enter(Material material, Visibility visibility) {
    PaletteIndex code = 0;
    if (visibility != Visibility::empty) {
      const bool transparent = visibility == Visibility::transparent;
      std::vector<Material>& numbered = of_class_[transparent ? 1 : 0];
      const auto number = static_cast<PaletteIndex>(numbered.size());
      code = transparent ? kTransparentBit | number : number + 1;
      numbered.push_back(material);
      if (fit_bytes()) of_byte_[code_as<BytePaletteIndex>(code)] = material;
    }
    of_[material] = code;
    seen_.push_back(material);
    return code;
  }

  std::vector<PaletteIndex> of_;  // by material
  std::vector<Material> seen_;
  std::array<std::vector<Material>, 2> of_class_;  // opaque and transparent, by number
  std::array<Material, 256> of_byte_{};            // by code, while they fit
};

}  // namespace runstone::rdm
