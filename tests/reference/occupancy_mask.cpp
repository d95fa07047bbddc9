#include "tests/reference/occupancy_mask.hpp"

#include <algorithm>
#include <bit>

#include "common/core/assert.hpp"
#include "tests/reference/row_compare.hpp"

namespace runstone::reference {
namespace {

/// Records whether there is more than one material.
struct OneMaterial {
  Material first = kEmpty;
  bool seen = false, one = true;
  void see(Material material) {
    if (!seen) first = material;
    seen = true;
    one &= material == first;
  }
};

/// Returns the bits of a voxel beyond the end of a line: before it, or (`behind`) after it.
unsigned end_bits(Visibility is, bool behind) {
  const unsigned bits = is == Visibility::opaque ? 1u : is == Visibility::transparent ? 4u : 0u;
  return behind ? bits << 1 : bits;
}

class Builder {
 public:
  Builder(const DenseGrid& grid, const VisibilityTable& visibility, OccupancyMask& mask)
      : grid_(grid), e_(grid.sides()), visibility_(visibility), mask_(mask) {
    RUNSTONE_ASSERT(e_.f <= kBinarySideMax && e_.m <= kBinarySideMax && e_.s <= kBinarySideMax);
    const std::size_t lines = std::size_t{e_.m + 2} * (e_.s + 2);
    mask.opaque.resize(lines);
    mask.transparent.resize(lines);
    mask.ends.resize(lines);
  }

  /// Opaque materials beyond the border hide every face; transparent ones are compared.
  Visibility look_up(Material material, bool inside) {
    const Visibility is = visibility_[material];
    if (is == Visibility::opaque && inside) opaque_.see(material);
    if (is == Visibility::transparent) transparent_.see(material);
    return is;
  }

  /// Makes the words of a line, border lines included, from the grid.
  void scan(std::ptrdiff_t m, std::ptrdiff_t s) {
    const bool inside = within(m, e_.m) && within(s, e_.s);
    const Material* const line = grid_.line(m, s);
    // Bit i: i + 1 differs.
    std::uint64_t changes = differing_bits(line, line + 1, e_.f) & (low_bits(e_.f) >> 1);
    std::uint64_t is_opaque = 0, is_transparent = 0;
    for (std::uint32_t from = 0;;) {
      const std::uint32_t to =
          changes == 0 ? e_.f : static_cast<std::uint32_t>(std::countr_zero(changes)) + 1;
      const Visibility is = look_up(line[from], inside);
      const std::uint64_t bits = low_bits(to - from) << from;
      is_opaque |= is == Visibility::opaque ? bits : 0;
      is_transparent |= is == Visibility::transparent ? bits : 0;
      if (changes == 0) break;
      changes &= changes - 1;
      from = to;
    }
    mask_.opaque[word_at(m, s)] = is_opaque;
    mask_.transparent[word_at(m, s)] = is_transparent;
  }

  /// Makes the words of the border lines from the grid; the edges of the border have none.
  void scan_border() {
    const auto m_side = static_cast<std::ptrdiff_t>(e_.m);
    const auto s_side = static_cast<std::ptrdiff_t>(e_.s);
    for (const std::ptrdiff_t s : {std::ptrdiff_t{-1}, s_side}) {
      for (std::ptrdiff_t m = 0; m < m_side; ++m) scan(m, s);
      for (const std::ptrdiff_t m : {std::ptrdiff_t{-1}, m_side}) {
        mask_.opaque[word_at(m, s)] = mask_.transparent[word_at(m, s)] = 0;
      }
    }
    for (const std::ptrdiff_t m : {std::ptrdiff_t{-1}, m_side}) {
      for (std::ptrdiff_t s = 0; s < s_side; ++s) scan(m, s);
    }
  }

  /// Records the voxels beyond the ends of all lines inside, from the grid.
  void scan_ends() {
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      for (std::uint32_t m = 0; m < e_.m; ++m) {
        const Material* const line = grid_.line(m, s);
        mask_.ends[word_at(m, s)] = static_cast<std::uint8_t>(
            end_bits(look_up(line[-1], false), false) | end_bits(look_up(line[e_.f], false), true));
      }
    }
  }

  void finish() {
    mask_.one_opaque = opaque_.one;
    mask_.one_transparent = transparent_.one;
    mask_.any_opaque = opaque_.seen;
    mask_.any_transparent = transparent_.seen;
    mask_.opaque_material = opaque_.first;
    mask_.transparent_material = transparent_.first;
  }

 private:
  static bool within(std::ptrdiff_t at, std::uint32_t side) {
    return at >= 0 && at < static_cast<std::ptrdiff_t>(side);
  }
  std::size_t word_at(std::ptrdiff_t m, std::ptrdiff_t s) const {
    return static_cast<std::size_t>((m + 1) + (static_cast<std::ptrdiff_t>(e_.m) + 2) * (s + 1));
  }
  const DenseGrid& grid_;
  OrderedExtent e_;
  const VisibilityTable& visibility_;
  OccupancyMask& mask_;
  OneMaterial opaque_, transparent_;
};

}  // namespace

static_assert(DenseGrid::kSlack >= kCompareSlack + 2);

void occupancy_of(const DenseGrid& grid, const VisibilityTable& visibility, OccupancyMask& mask) {
  Builder builder(grid, visibility, mask);
  const OrderedExtent e = grid.sides();
  for (std::uint32_t s = 0; s < e.s; ++s) {
    for (std::uint32_t m = 0; m < e.m; ++m) builder.scan(m, s);
  }
  builder.scan_border();
  builder.scan_ends();
  builder.finish();
}

}  // namespace runstone::reference
