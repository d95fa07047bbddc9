#include "common/mesh/reference/occupancy_mask.hpp"

#include <bit>

#include "common/core/assert.hpp"
#include "common/mesh/reference/row_compare.hpp"

namespace runstone::reference {
namespace {

/// Remembers whether more than one material was seen.
struct OneMaterial {
  Material first = kEmpty;
  bool seen = false, one = true;
  void see(Material material) {
    if (!seen) {
      first = material;
      seen = true;
    }
    one = one && material == first;
  }
};

}  // namespace

static_assert(DenseGrid::kSlack >= kCompareSlack + 2);

void occupancy_of(const DenseGrid& grid, const VisibilityTable& visibility, OccupancyMask& mask) {
  const OrderedExtent e = grid.sides();
  RUNSTONE_ASSERT(e.f <= kBinarySideMax && e.m <= kBinarySideMax && e.s <= kBinarySideMax);
  const std::size_t lines = std::size_t{e.m + 2} * (e.s + 2);
  mask.opaque.resize(lines);
  mask.transparent.resize(lines);
  mask.ends.resize(lines);
  OneMaterial opaque, transparent;
  std::size_t word = 0;
  for (std::ptrdiff_t s = -1; s <= static_cast<std::ptrdiff_t>(e.s); ++s) {
    const bool s_inside = s >= 0 && s < static_cast<std::ptrdiff_t>(e.s);
    for (std::ptrdiff_t m = -1; m <= static_cast<std::ptrdiff_t>(e.m); ++m, ++word) {
      const bool m_inside = m >= 0 && m < static_cast<std::ptrdiff_t>(e.m);
      std::uint64_t is_opaque = 0, is_transparent = 0;
      unsigned ends = 0;
      if (s_inside || m_inside) {  // not an edge of the border
        const bool inside = s_inside && m_inside;
        // Opaque materials beyond the border hide faces whatever they are; transparent ones are compared.
        const auto look_up = [&](Material material, bool counts) {
          const Visibility is = visibility[material];
          if (is == Visibility::opaque && counts) opaque.see(material);
          if (is == Visibility::transparent) transparent.see(material);
          return is;
        };
        const Material* const line = grid.line(m, s);
        std::uint64_t changes =
            differing_bits(line, line + 1, e.f) & (low_bits(e.f) >> 1);  // bit i: i + 1 differs
        for (std::uint32_t from = 0;;) {
          const std::uint32_t to =
              changes == 0 ? e.f : static_cast<std::uint32_t>(std::countr_zero(changes)) + 1;
          const Visibility is = look_up(line[from], inside);
          const std::uint64_t bits = low_bits(to - from) << from;
          is_opaque |= is == Visibility::opaque ? bits : 0;
          is_transparent |= is == Visibility::transparent ? bits : 0;
          if (changes == 0) break;
          changes &= changes - 1;
          from = to;
        }
        if (inside) {
          const Visibility before = look_up(line[-1], false);
          const Visibility behind = look_up(line[e.f], false);
          ends = (before == Visibility::opaque ? 1u : 0u) | (behind == Visibility::opaque ? 2u : 0u) |
                 (before == Visibility::transparent ? 4u : 0u) |
                 (behind == Visibility::transparent ? 8u : 0u);
        }
      }
      mask.opaque[word] = is_opaque;
      mask.transparent[word] = is_transparent;
      mask.ends[word] = static_cast<std::uint8_t>(ends);
    }
  }
  mask.one_opaque = opaque.one;
  mask.one_transparent = transparent.one;
  mask.any_opaque = opaque.seen;
  mask.any_transparent = transparent.seen;
}

}  // namespace runstone::reference
