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

  /// Makes the words of all lines inside, from runs.
  template <class Runs>
  void scan_runs(const Runs& runs) {
    std::uint64_t* opaque = mask_.opaque.data() + word_at(0, 0);
    std::uint64_t* transparent = mask_.transparent.data() + word_at(0, 0);
    std::uint64_t is_opaque = 0, is_transparent = 0;  // of the line so far
    std::uint32_t at = 0;                             // in the line
    std::uint32_t lines_left = e_.m;
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const Visibility is = look_up(runs.material(i), true);
      const std::uint64_t if_opaque = is == Visibility::opaque ? ~std::uint64_t{0} : 0;
      const std::uint64_t if_transparent = is == Visibility::transparent ? ~std::uint64_t{0} : 0;
      const std::uint32_t end = runs.end(i);
      do {
        const std::uint32_t length = std::min(end - begin, e_.f - at);
        const std::uint64_t bits = low_bits(length) << at;
        is_opaque |= if_opaque & bits;
        is_transparent |= if_transparent & bits;
        begin += length;
        at += length;
        if (at < e_.f) break;
        *opaque++ = is_opaque;
        *transparent++ = is_transparent;
        is_opaque = is_transparent = 0;
        at = 0;
        if (--lines_left == 0) {
          lines_left = e_.m;
          opaque += 2;
          transparent += 2;
        }
      } while (begin < end);
    }
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
    for_each_line([this](std::ptrdiff_t m, std::ptrdiff_t s) {
      const Material* const line = grid_.line(m, s);
      return end_bits(look_up(line[-1], false), false) | end_bits(look_up(line[e_.f], false), true);
    });
  }
  /// Does the same where every line has one material before it and one behind it.
  void set_ends(Material before, Material behind) {
    const unsigned ends =
        end_bits(look_up(before, false), false) | end_bits(look_up(behind, false), true);
    for_each_line([ends](std::ptrdiff_t, std::ptrdiff_t) { return ends; });
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
  template <class Ends>
  void for_each_line(Ends&& ends) {
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      for (std::uint32_t m = 0; m < e_.m; ++m)
        mask_.ends[word_at(m, s)] = static_cast<std::uint8_t>(ends(m, s));
    }
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

void occupancy_of_decoded(const RunChunk& chunk, const GridNeighbours& neighbours,
                          const DenseGrid& grid, const VisibilityTable& visibility,
                          OccupancyMask& mask) {
  RUNSTONE_ASSERT(grid.extent() == chunk.extent && grid.order() == chunk.order);
  const OrderedExtent e = grid.sides();
  // Where lines hold many runs, comparing voxels side by side is faster than iterating over runs.
  if (chunk.runs.size() > std::size_t{6} * e.m * e.s) return occupancy_of(grid, visibility, mask);
  Builder builder(grid, visibility, mask);
  chunk.runs.visit([&](const auto& runs) { builder.scan_runs(runs); });
  builder.scan_border();
  const auto fast = 2 * static_cast<std::size_t>(axes_of(chunk.order)[0]);
  const RunChunk* const before = neighbours[fast];
  const RunChunk* const behind = neighbours[fast + 1];
  const auto uniform = [](const RunChunk* c) { return c == nullptr || c->is_uniform(); };
  const auto material = [](const RunChunk* c) {
    return c == nullptr ? kEmpty : c->runs.material(0);
  };
  if (uniform(before) && uniform(behind)) {
    builder.set_ends(material(before), material(behind));
  } else {
    builder.scan_ends();
  }
  builder.finish();
}

}  // namespace runstone::reference
