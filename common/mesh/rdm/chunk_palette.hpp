// ChunkPalette: small numbers for the materials of one chunk. With them a layer takes a few cache
// lines, and 64 voxels are compared at once. Indices are given in the order in which materials
// occur. Opaque and transparent materials are counted apart, and all empty ones have index 0.
//   opaque        1, 2, ...
//   transparent   kTransparentBit + 0, 1, ...
// The indices of a chunk with few materials are kept as bytes; then the highest bit of the byte
// replaces kTransparentBit.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "common/mesh/visibility.hpp"

namespace runstone::rdm {

using PaletteIndex = std::uint32_t;
using BytePaletteIndex = std::uint8_t;
inline constexpr PaletteIndex kTransparentBit = PaletteIndex{1} << 31;

/// Returns an index in the type Index. As a BytePaletteIndex it is valid only if the palette fits
/// into bytes once it is complete (ChunkPalette::fit_bytes()).
template <class Index>
constexpr Index index_as(PaletteIndex index) {
  return static_cast<Index>(sizeof(Index) == 1 ? index | index >> 24 : index);
}
/// Returns the index from which index_as() made its result.
constexpr PaletteIndex full_index(PaletteIndex index) { return index; }
constexpr PaletteIndex full_index(BytePaletteIndex index) {
  return (index & 0x7fu) | PaletteIndex{index} >> 7 << 31;
}

class ChunkPalette {
 public:
  ChunkPalette() : of_(kMaterialCountMax, kUnseen) {}

  /// Removes all indices. Cost: O(materials seen).
  void clear() {
    for (const Material material : seen_) of_[material] = kUnseen;
    seen_.clear();
    for (auto& numbered : of_class_) numbered.clear();
  }
  /// Writes the index of the material of each run i in [first, last) to out[i]. The first run of a
  /// material assigns it. `runs` is a view of a RunList. Cost: O(runs).
  template <class Runs, class Index>
  void list(Runs runs, std::size_t first, std::size_t last, const VisibilityTable& visibility,
            Index* out) {
    // In a register: for the compiler, a write of bytes may change the members.
    const PaletteIndex* const of = of_.data();
    for (std::size_t i = first; i < last; ++i) {
      const Material material = runs.material(i);
      PaletteIndex index = of[material];
      if (index == kUnseen) index = enter(material, visibility[material]);
      out[i] = index_as<Index>(index);
    }
  }
  /// Returns the index of a material if it is a transparent one of the chunk, otherwise 0.
  PaletteIndex transparent_index(Material material) const {
    const PaletteIndex index = of_[material];
    return index != kUnseen && (index & kTransparentBit) != 0 ? index : 0;
  }

  /// Returns the materials that have an index, in the order in which they got it.
  std::span<const Material> seen() const { return seen_; }
  /// Returns the index of a material. Requires that it has one.
  PaletteIndex index(Material material) const { return of_[material]; }

  std::size_t transparent_count() const { return of_class_[1].size(); }
  bool has_transparent() const { return transparent_count() != 0; }
  /// Returns the transparent materials, by number.
  std::span<const Material> transparent() const { return of_class_[1]; }
  /// Returns the number of materials that are not empty.
  std::size_t solid_count() const { return of_class_[0].size() + of_class_[1].size(); }
  /// Returns the material that is not empty. Requires that there is only one.
  Material single() const { return of_class_[has_transparent() ? 1 : 0].front(); }

  /// Returns true if each index fits into a byte.
  bool fit_bytes() const { return of_class_[0].size() <= 127 && of_class_[1].size() <= 128; }
  /// Returns the material of an assigned index other than 0.
  Material material(BytePaletteIndex index) const { return of_byte_[index]; }
  Material material(PaletteIndex index) const {
    return (index & kTransparentBit) != 0 ? of_class_[1][index ^ kTransparentBit]
                                          : of_class_[0][index - 1];
  }

 private:
  static constexpr PaletteIndex kUnseen = std::numeric_limits<PaletteIndex>::max();

  PaletteIndex enter(Material material, Visibility visibility) {
    PaletteIndex index = 0;
    if (visibility != Visibility::empty) {
      const bool transparent = visibility == Visibility::transparent;
      std::vector<Material>& numbered = of_class_[transparent ? 1 : 0];
      const auto number = static_cast<PaletteIndex>(numbered.size());
      index = transparent ? kTransparentBit | number : number + 1;
      numbered.push_back(material);
      if (fit_bytes()) of_byte_[index_as<BytePaletteIndex>(index)] = material;
    }
    of_[material] = index;
    seen_.push_back(material);
    return index;
  }

  std::vector<PaletteIndex> of_;  // by material
  std::vector<Material> seen_;
  std::array<std::vector<Material>, 2> of_class_;  // opaque and transparent, by number
  std::array<Material, 256> of_byte_{};            // by byte index, while they fit
};

}  // namespace runstone::rdm
