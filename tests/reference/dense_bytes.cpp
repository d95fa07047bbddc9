#include "tests/reference/dense_bytes.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "common/core/assert.hpp"
#include "common/runs/dense.hpp"
#include "tests/reference/row_compare.hpp"

namespace runstone::reference {
namespace {

using Word = std::uint64_t;

/// Returns the opaque voxels of a line, and those that are transparent.
Word opaque_of(const DenseBytes& of, const PaletteId* line, std::uint32_t count) {
  return ids_below(line, count, of.transparent_first) & ~ids_below(line, count, of.opaque_first);
}
Word transparent_of(const DenseBytes& of, const PaletteId* line, std::uint32_t count) {
  return ~ids_below(line, count, of.transparent_first) & low_bits(count);
}

/// Writes the voxels around a chunk into the grid and the mask of its volume.
class BorderFill {
 public:
  explicit BorderFill(PaletteVolume& out) : e_(out.grid.sides()), out_(out) {}

  /// Writes the border line at (m, s), which lies beyond the chunk, from a neighbour's line.
  void line(const DenseBytes& of, const PaletteId* from, std::ptrdiff_t m, std::ptrdiff_t s) {
    const std::size_t word = word_at(m, s);
    out_.mask.opaque[word] = opaque_of(of, from, e_.f);
    out_.mask.transparent[word] = 0;
    if (!out_.mask.any_transparent) return;
    for (Word left = transparent_of(of, from, e_.f); left != 0; left &= left - 1) {
      const int f = std::countr_zero(left);
      const auto known = out_.palette.known(of.materials[from[f]]);
      if (!known) continue;
      out_.mask.transparent[word] |= Word{1} << f;
      out_.grid.line(m, s)[f] = *known;
    }
  }
  /// Writes the voxels before or behind all lines. `from` is the one beside the first line, and the
  /// next ones are `step` ids further.
  void ends(const DenseBytes& of, const PaletteId* from, std::uint32_t step, bool is_behind) {
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      std::uint8_t* const ends = out_.mask.ends.data() + word_at(0, s);
      for (std::uint32_t m = 0; m < e_.m; ++m, from += step) {
        const PaletteId id = *from;
        const bool is_opaque = id >= of.opaque_first && id < of.transparent_first;
        ends[m] = static_cast<std::uint8_t>(ends[m] | (is_opaque ? 1 : 0) << (is_behind ? 1 : 0));
        if (!out_.mask.any_transparent || id < of.transparent_first) continue;
        const auto known = out_.palette.known(of.materials[id]);
        if (!known) continue;
        ends[m] = static_cast<std::uint8_t>(ends[m] | 1 << (is_behind ? 3 : 2));
        out_.grid.line(m, s)[is_behind ? static_cast<std::ptrdiff_t>(e_.f) : -1] = *known;
      }
    }
  }
  std::size_t word_at(std::ptrdiff_t m, std::ptrdiff_t s) const {
    return static_cast<std::size_t>((m + 1) + (static_cast<std::ptrdiff_t>(e_.m) + 2) * (s + 1));
  }

 private:
  const OrderedExtent e_;
  PaletteVolume& out_;
};

void fill_inside(const DenseBytes& chunk, const BorderFill& places, PaletteVolume& out) {
  const OrderedExtent e = out.grid.sides();
  const PaletteId* from = chunk.ids.data();
  for (std::uint32_t s = 0; s < e.s; ++s) {
    for (std::uint32_t m = 0; m < e.m; ++m, from += e.f) {
      std::memcpy(out.grid.line(m, s), from, e.f);
      const std::size_t word = places.word_at(m, s);
      out.mask.opaque[word] = opaque_of(chunk, from, e.f);
      out.mask.transparent[word] = transparent_of(chunk, from, e.f);
    }
  }
}

void set_flags(const DenseBytes& chunk, OccupancyMask& mask) {
  const std::size_t opaque = chunk.transparent_first - chunk.opaque_first;
  const std::size_t transparent = chunk.materials.size() - chunk.transparent_first;
  mask.any_opaque = opaque != 0;
  mask.any_transparent = transparent != 0;
  mask.one_opaque = opaque <= 1;
  mask.one_transparent = transparent <= 1;
  mask.opaque_material = mask.any_opaque ? chunk.materials[chunk.opaque_first] : kEmpty;
  mask.transparent_material =
      mask.any_transparent ? chunk.materials[chunk.transparent_first] : kEmpty;
}

}  // namespace

std::optional<DenseBytes> dense_bytes(const RunChunk& chunk, const VisibilityTable& visibility) {
  DenseBytes out;
  out.extent = chunk.extent;
  out.order = chunk.order;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
    const Material material = chunk.runs.material(i);
    if (std::find(out.materials.begin(), out.materials.end(), material) == out.materials.end())
      out.materials.push_back(material);
  }
  if (out.materials.size() > BytePalette::kIdsMax) return std::nullopt;
  const auto rank = [&visibility](Material material) {
    return visibility[material] == Visibility::empty    ? 0
           : visibility[material] == Visibility::opaque ? 1
                                                        : 2;
  };
  std::sort(out.materials.begin(), out.materials.end(),
            [&](Material a, Material b) { return std::pair(rank(a), a) < std::pair(rank(b), b); });
  const auto first_of = [&](int wanted) {
    return static_cast<std::uint16_t>(
        std::count_if(out.materials.begin(), out.materials.end(),
                      [&](Material material) { return rank(material) < wanted; }));
  };
  out.opaque_first = first_of(1);
  out.transparent_first = first_of(2);
  out.ids.reserve(chunk.volume() + kCompareSlack);
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
    const auto id = std::find(out.materials.begin(), out.materials.end(), chunk.runs.material(i)) -
                    out.materials.begin();
    out.ids.resize(chunk.runs.end(i), static_cast<PaletteId>(id));
  }
  out.ids.resize(chunk.volume() + kCompareSlack);
  return out;
}

void fill_volume(const DenseBytes& chunk, const DenseNeighbours& neighbours,
                 const VisibilityTable& visibility, PaletteVolume& out) {
  count_dense_expansion();
  out.palette.clear();
  for (const Material material : chunk.materials)
    static_cast<void>(out.palette.id_of(material, visibility));
  out.grid.reset(chunk.extent, chunk.order);
  const OrderedExtent e = out.grid.sides();
  RUNSTONE_ASSERT(std::max({e.f, e.m, e.s}) <= kBinarySideMax);
  const std::size_t lines = std::size_t{e.m + 2} * (e.s + 2);
  out.mask.opaque.assign(lines, 0);
  out.mask.transparent.assign(lines, 0);
  out.mask.ends.assign(lines, 0);
  set_flags(chunk, out.mask);
  BorderFill border(out);
  fill_inside(chunk, border, out);
  const auto axes = axes_of(chunk.order);
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const DenseBytes* const of = neighbours[d];
    if (of == nullptr) continue;
    RUNSTONE_ASSERT(of->order == chunk.order);
    const Axis axis = axis_of(static_cast<Direction>(d));
    const bool is_behind = is_positive(static_cast<Direction>(d));
    const OrderedExtent n = ordered(of->extent, of->order);
    if (axis == axes[0]) {
      border.ends(*of, of->ids.data() + (is_behind ? 0 : n.f - 1), n.f, is_behind);
    } else if (axis == axes[1]) {
      for (std::uint32_t s = 0; s < e.s; ++s)
        border.line(*of,
                    of->ids.data() + std::size_t{s} * n.layer() + (is_behind ? 0 : n.m - 1) * n.f,
                    is_behind ? std::ptrdiff_t{e.m} : -1, s);
    } else {
      for (std::uint32_t m = 0; m < e.m; ++m)
        border.line(*of,
                    of->ids.data() + std::size_t{is_behind ? 0 : n.s - 1} * n.layer() + m * n.f, m,
                    is_behind ? std::ptrdiff_t{e.s} : -1);
    }
  }
}

}  // namespace runstone::reference
