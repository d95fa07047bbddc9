#include "tests/reference/palette_decode.hpp"

#include <algorithm>
#include <cstring>
#include <span>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/border_rows.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/layer.hpp"
#include "tests/reference/row_compare.hpp"

namespace runstone::reference {
namespace {

using Word = std::uint64_t;

/// The sides of a volume, and the places of its lines in an OccupancyMask.
struct Lines {
  OrderedExtent e;
  std::size_t word_at(std::ptrdiff_t m, std::ptrdiff_t s) const {
    return static_cast<std::size_t>((m + 1) + (static_cast<std::ptrdiff_t>(e.m) + 2) * (s + 1));
  }
  std::size_t count() const { return std::size_t{e.m + 2} * (e.s + 2); }
};

void resize(OccupancyMask& mask, std::size_t lines) {
  mask.opaque.resize(lines);
  mask.transparent.resize(lines);
  mask.ends.resize(lines);
}

/// Sets the flags of a mask. All materials of a palette occur.
void set_flags(const BytePalette& palette, OccupancyMask& mask) {
  std::size_t opaque = 0, transparent = 0;
  mask.opaque_material = mask.transparent_material = kEmpty;
  for (std::size_t id = palette.materials().size(); id-- != 0;) {
    const auto at = static_cast<std::uint16_t>(id);
    if (palette.opaque(at) != 0) {
      ++opaque;
      mask.opaque_material = palette.materials()[id];
    } else if (palette.transparent(at) != 0) {
      ++transparent;
      mask.transparent_material = palette.materials()[id];
    }
  }
  mask.any_opaque = opaque != 0;
  mask.any_transparent = transparent != 0;
  mask.one_opaque = opaque <= 1;
  mask.one_transparent = transparent <= 1;
}

/// Writes ids and words of all lines inside. Returns false if there are too many materials.
template <class Runs>
bool decode_inside(const Runs& runs, const VisibilityTable& visibility, const Lines& lines,
                   PaletteVolume& out) {
  const OrderedExtent e = lines.e;
  BytePalette& palette = out.palette;
  PaletteId* line = out.grid.line(0, 0);
  const std::ptrdiff_t line_stride = out.grid.line_stride();
  const std::ptrdiff_t layer_step = out.grid.layer_stride() - line_stride * (e.m - 1);
  Word* opaque = out.mask.opaque.data() + lines.word_at(0, 0);
  Word* transparent = out.mask.transparent.data() + lines.word_at(0, 0);
  Word is_opaque = 0, is_transparent = 0;  // of the line so far
  std::uint32_t at = 0;                    // in the line
  std::uint32_t lines_left = e.m;
  std::uint32_t begin = 0;
  const std::size_t size = runs.size();
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint16_t id = palette.id_of(runs.material(i), visibility);
    if (id == BytePalette::kIdsMax) return false;
    const Word all_opaque = palette.opaque(id), all_transparent = palette.transparent(id);
    const std::uint32_t end = runs.end(i);
    do {
      const std::uint32_t length = std::min(end - begin, e.f - at);
      // Two or four stores of constant size: what they write too much, later runs overwrite.
      std::memset(line + at, id, kBinarySideMax);
      const Word bits = low_bits(length) << at;
      is_opaque |= all_opaque & bits;
      is_transparent |= all_transparent & bits;
      begin += length;
      at += length;
      if (at < e.f) break;
      *opaque++ = is_opaque;
      *transparent++ = is_transparent;
      is_opaque = is_transparent = 0;
      at = 0;
      if (--lines_left != 0) {
        line += line_stride;
      } else {
        lines_left = e.m;
        line += layer_step;
        opaque += 2;
        transparent += 2;
      }
    } while (begin < end);
  }
  return true;
}
static_assert(PaletteGrid::kSlack >= kBinarySideMax);

/// The layer of a neighbour that touches the chunk: which voxels are opaque, and which have a
/// transparent material of the chunk.
struct BorderRows {
  using Rows = std::array<Word, kBinarySideMax>;
  std::array<Rows, 2> planes;
  const Rows& opaque() const { return planes[0]; }
  const Rows& transparent() const { return planes[1]; }
};

void read_rows(const RunChunk* neighbour, const rdm::LayerPlace& place,
               const VisibilityTable& visibility, const BytePalette& palette,
               bool wants_transparent, BorderRows& out) {
  if (neighbour == nullptr) {
    for (auto& plane : out.planes) plane.fill(0);
    return;
  }
  if (!wants_transparent) {
    std::array<BorderRows::Rows, 1> plane;
    rdm::read_layer_rows(*neighbour, place, plane,
                         [table = visibility.data()](Material material) -> rdm::PaletteIndex {
                           return table[material] == Visibility::opaque ? 1 : 0;
                         });
    out.planes[0] = plane[0];
    out.planes[1].fill(0);
    return;
  }
  rdm::read_layer_rows(
      *neighbour, place, out.planes,
      [table = visibility.data(), &palette](Material material) -> rdm::PaletteIndex {
        if (table[material] == Visibility::opaque) return 1;
        return table[material] == Visibility::transparent && palette.known(material) ? 2 : 0;
      });
}

/// Writes the ids of a border layer. Materials that the chunk does not have may get any id: the mask
/// says that they are not transparent ones of the chunk.
void write_ids(const RunChunk& neighbour, const rdm::LayerPlace& place, Direction direction,
               PaletteVolume& out) {
  const auto sides = out.grid.extent().sides();
  const std::size_t us = sides[static_cast<std::size_t>(place.bit_axis)];
  const std::size_t vs = sides[static_cast<std::size_t>(place.row_axis())];
  out.layer.resize(us * vs);
  read_layer(neighbour, place.axis, place.at, place.bit_axis, std::span(out.layer));
  const std::ptrdiff_t beyond =
      is_positive(direction) ? std::ptrdiff_t{sides[static_cast<std::size_t>(place.axis)]} : -1;
  PaletteId* const first = out.grid.line(0, 0) + beyond * out.grid.stride(place.axis);
  const Material* from = out.layer.data();
  for (std::size_t v = 0; v < vs; ++v) {
    PaletteId* to = first + static_cast<std::ptrdiff_t>(v) * out.grid.stride(place.row_axis());
    for (std::size_t u = 0; u < us; ++u, to += out.grid.stride(place.bit_axis))
      *to = out.palette.known(*from++).value_or(0);
  }
}

void decode_borders(const GridNeighbours& neighbours, const VisibilityTable& visibility,
                    const Lines& lines, PaletteVolume& out) {
  const OrderedExtent e = lines.e;
  const std::array<Axis, 3> axes = axes_of(out.grid.order());
  OccupancyMask& mask = out.mask;
  BorderRows rows;
  std::array<BorderRows, 2> fast;
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    const auto direction = static_cast<Direction>(d);
    const Axis axis = axis_of(direction);
    const bool is_behind = is_positive(direction);
    const Axis bit_axis = axis == axes[0] ? axes[1] : axes[0];
    const RunChunk* const of = neighbours[d];
    const std::uint32_t depth =
        of == nullptr ? 1 : of->extent.sides()[static_cast<std::size_t>(axis)];
    const rdm::LayerPlace place{axis, bit_axis, is_behind ? 0 : depth - 1};
    BorderRows& to = axis == axes[0] ? fast[is_behind ? 1 : 0] : rows;
    read_rows(of, place, visibility, out.palette, mask.any_transparent, to);
    if (!mask.one_transparent && std::any_of(to.transparent().begin(), to.transparent().end(),
                                             [](Word w) { return w != 0; }))
      write_ids(*of, place, direction, out);
    if (axis == axes[2]) {
      const std::size_t word = lines.word_at(0, is_behind ? std::ptrdiff_t{e.s} : -1);
      std::copy_n(to.opaque().begin(), e.m,
                  mask.opaque.begin() + static_cast<std::ptrdiff_t>(word));
      std::copy_n(to.transparent().begin(), e.m,
                  mask.transparent.begin() + static_cast<std::ptrdiff_t>(word));
    } else if (axis == axes[1]) {
      for (std::uint32_t s = 0; s < e.s; ++s) {
        const std::size_t word = lines.word_at(is_behind ? std::ptrdiff_t{e.m} : -1, s);
        mask.opaque[word] = to.opaque()[s];
        mask.transparent[word] = to.transparent()[s];
      }
    }
  }
  for (std::uint32_t s = 0; s < e.s; ++s) {
    const Word before = fast[0].opaque()[s], behind = fast[1].opaque()[s];
    const Word clear_before = fast[0].transparent()[s], clear_behind = fast[1].transparent()[s];
    std::uint8_t* const ends = mask.ends.data() + lines.word_at(0, s);
    for (std::uint32_t m = 0; m < e.m; ++m) {
      ends[m] =
          static_cast<std::uint8_t>((before >> m & 1) | (behind >> m & 1) << 1 |
                                    (clear_before >> m & 1) << 2 | (clear_behind >> m & 1) << 3);
    }
  }
}

}  // namespace

void BytePalette::clear() {
  for (const Material material : materials_) of_[material] = kUnseen;
  materials_.clear();
}

std::optional<PaletteId> BytePalette::known(Material material) const {
  const std::uint16_t id = of_[material];
  if (id == kUnseen) return std::nullopt;
  return static_cast<PaletteId>(id);
}

std::uint16_t BytePalette::enter(Material material, Visibility visibility) {
  if (materials_.size() == kIdsMax) return kIdsMax;
  const auto id = static_cast<std::uint16_t>(materials_.size());
  opaque_[id] = visibility == Visibility::opaque ? ~Word{0} : 0;
  transparent_[id] = visibility == Visibility::transparent ? ~Word{0} : 0;
  materials_.push_back(material);
  of_[material] = id;
  return id;
}

bool decode_palette(const RunChunk& chunk, const GridNeighbours& neighbours,
                    const VisibilityTable& visibility, PaletteVolume& out) {
  count_dense_expansion();
  out.palette.clear();
  out.grid.reset(chunk.extent, chunk.order);
  const Lines lines{out.grid.sides()};
  RUNSTONE_ASSERT(lines.e.f <= kBinarySideMax && lines.e.m <= kBinarySideMax &&
                  lines.e.s <= kBinarySideMax);
  resize(out.mask, lines.count());
  const bool fits = chunk.runs.visit(
      [&](const auto& runs) { return decode_inside(runs, visibility, lines, out); });
  if (!fits) return false;
  set_flags(out.palette, out.mask);
  decode_borders(neighbours, visibility, lines, out);
  return true;
}

std::optional<PaddedRuns> padded_runs(const RunChunk& chunk, const GridNeighbours& neighbours) {
  DenseGrid grid;
  std::vector<Material> layer;
  decode(chunk, neighbours, layer, grid);
  PaddedRuns out;
  out.extent = chunk.extent;
  out.order = chunk.order;
  const OrderedExtent e = grid.sides();
  const auto m_side = static_cast<std::ptrdiff_t>(e.m), s_side = static_cast<std::ptrdiff_t>(e.s);
  Material last = kEmpty;
  std::uint32_t end = 0;
  for (std::ptrdiff_t s = -1; s <= s_side; ++s) {
    for (std::ptrdiff_t m = -1; m <= m_side; ++m) {
      const bool is_edge = (s < 0 || s == s_side) && (m < 0 || m == m_side);
      const bool is_border = s < 0 || s == s_side || m < 0 || m == m_side;
      for (std::ptrdiff_t f = -1; f <= static_cast<std::ptrdiff_t>(e.f); ++f, ++end) {
        const bool is_end = f < 0 || f == static_cast<std::ptrdiff_t>(e.f);
        const Material here = is_edge || (is_border && is_end) ? last : grid.line(m, s)[f];
        if (here == last && !out.ends.empty()) {
          out.ends.back() = end + 1;
          continue;
        }
        auto known = std::find(out.materials.begin(), out.materials.end(), here);
        if (known == out.materials.end()) {
          if (out.materials.size() == BytePalette::kIdsMax) return std::nullopt;
          known = out.materials.insert(known, here);
        }
        out.ends.push_back(end + 1);
        out.ids.push_back(static_cast<PaletteId>(known - out.materials.begin()));
        last = here;
      }
    }
  }
  return out;
}

void decode_palette(const PaddedRuns& runs, const VisibilityTable& visibility, PaletteVolume& out) {
  count_dense_expansion();
  out.palette.clear();
  for (const Material material : runs.materials)
    static_cast<void>(out.palette.id_of(material, visibility));
  out.grid.reset(runs.extent, runs.order);
  const Lines lines{out.grid.sides()};
  const OrderedExtent e = lines.e;
  RUNSTONE_ASSERT(e.f <= kPaddedSideMax && e.m <= kPaddedSideMax && e.s <= kPaddedSideMax);
  resize(out.mask, lines.count());
  set_flags(out.palette, out.mask);
  PaletteId* const voxels = out.grid.line(-1, -1) - 1;  // a padded volume is flattened as the grid
  const std::uint32_t side = e.f + 2;
  const Word inside = low_bits(e.f);
  std::size_t line = 0;
  Word is_opaque = 0, is_transparent = 0;  // of the line so far, border voxels included
  std::uint32_t at = 0, begin = 0;
  for (std::size_t i = 0; i < runs.ends.size(); ++i) {
    const PaletteId id = runs.ids[i];
    const Word all_opaque = out.palette.opaque(id), all_transparent = out.palette.transparent(id);
    std::memset(voxels + begin, id, runs.ends[i] - begin);
    do {
      const std::uint32_t length = std::min(runs.ends[i] - begin, side - at);
      const Word bits = low_bits(length) << at;
      is_opaque |= all_opaque & bits;
      is_transparent |= all_transparent & bits;
      begin += length;
      at += length;
      if (at < side) break;
      out.mask.opaque[line] = is_opaque >> 1 & inside;
      out.mask.transparent[line] = is_transparent >> 1 & inside;
      out.mask.ends[line] = static_cast<std::uint8_t>(
          (is_opaque & 1) | (is_opaque >> (side - 1)) << 1 | (is_transparent & 1) << 2 |
          (is_transparent >> (side - 1)) << 3);
      ++line;
      is_opaque = is_transparent = 0;
      at = 0;
    } while (begin < runs.ends[i]);
  }
}

}  // namespace runstone::reference
