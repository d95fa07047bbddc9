#include "tests/reference/binary_greedy.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "common/core/assert.hpp"
#include "tests/reference/bit_matrix.hpp"
#include "tests/reference/row_compare.hpp"

// As the sweep of the product, the mesher is compiled once per instruction set. Highway selects one
// at run time: counting bits takes one instruction on newer processors, and several on the oldest.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/reference/binary_greedy.cpp"
#include <hwy/foreach_target.h>
// Highway requires this include after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace runstone::reference {
namespace HWY_NAMESPACE {
namespace {

using Word = std::uint64_t;
using Plane = std::array<Word, kBinarySideMax>;

/// Packs the quads of one direction. `bit_axis` is the axis along which the words' bits lie.
struct Shape {
  Shape(Direction direction, Axis bit_axis, Axis word_axis)
      : base(static_cast<std::uint64_t>(direction) << 35),
        layer_shift(7 * static_cast<unsigned>(axis_of(direction))),
        bit_shift(7 * static_cast<unsigned>(bit_axis)),
        word_shift(7 * static_cast<unsigned>(word_axis)),
        bits_shift(u_axis_of(axis_of(direction)) == bit_axis ? 21 : 28),
        words_shift(u_axis_of(axis_of(direction)) == bit_axis ? 28 : 21) {}
  std::uint64_t base;
  unsigned layer_shift, bit_shift, word_shift, bits_shift, words_shift;
};

/// One pass over the faces of one visibility class. kOne means that all its voxels have one
/// material, so that nothing has to be compared.
template <class Grid, bool kTransparent, bool kOne>
class Pass {
 public:
  using Voxel = typename Grid::Voxel;

  /// `materials` are those of the palette, if the grid holds palette ids.
  Pass(const Grid& grid, const Material* materials, const OccupancyMask& mask,
       BinaryScratch& scratch, QuadLayers& out)
      : grid_(grid),
        materials_(materials),
        mask_(mask),
        e_(grid.sides()),
        axes_(axes_of(grid.order())),
        own_(kTransparent ? mask.transparent.data() : mask.opaque.data()),
        opaque_(mask.opaque.data()),
        one_material_(kTransparent ? mask.transparent_material : mask.opaque_material),
        scratch_(scratch),
        out_(out) {}

  void run() {
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const Axis axis = axis_of(direction);
      if (axis == axes_[0]) {
        across_fast(direction);
      } else if (axis == axes_[1]) {
        across_middle(direction);
      } else {
        across_slow(direction);
      }
    }
    out_.first[kDirectionCount * kSideMax] = count_;
    out_.quads.assign(scratch_.quads.begin(), scratch_.quads.begin() + count_);
  }

 private:
  std::size_t word_at(std::uint32_t m, std::uint32_t s) const {
    return (m + 1) + std::size_t{e_.m + 2} * (s + 1);
  }

  /// Returns the voxels that hide faces of this pass, whatever the material of the faces.
  Word hiding(std::size_t word) const {
    if constexpr (kTransparent && kOne) return opaque_[word] | own_[word];
    return opaque_[word];
  }

  /// Returns the faces of line m, s towards the line that lies `word_step` words and `voxel_step`
  /// voxels further, as bits along the line.
  Word faces(std::uint32_t m, std::uint32_t s, std::ptrdiff_t word_step,
             std::ptrdiff_t voxel_step) const {
    const std::size_t word = word_at(m, s);
    const std::size_t other = word + static_cast<std::size_t>(word_step);
    const Word shown = own_[word] & ~hiding(other);
    if constexpr (!kTransparent || kOne) return shown;
    if ((shown & own_[other]) == 0) return shown;
    const Voxel* const line = grid_.line(m, s);
    return shown & (~own_[other] | differing_bits(line, line + voxel_step, e_.f));
  }

  /// Merges the layers of the slowest axis, whose words lie together.
  void across_slow(Direction direction) {
    const Shape shape(direction, axes_[0], axes_[1]);
    const std::ptrdiff_t sign = is_positive(direction) ? 1 : -1;
    Plane plane;
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      start_layer(direction, s);
      Word any = 0;
      for (std::uint32_t m = 0; m < e_.m; ++m) {
        plane[m] = faces(m, s, sign * (static_cast<std::ptrdiff_t>(e_.m) + 2),
                         sign * grid_.layer_stride());
        any |= plane[m];
      }
      if (any != 0)
        merge<true>(plane.data(), e_.m, grid_.line(0, s), 1, grid_.line_stride(), shape, s);
    }
    end_layers(direction, e_.s);
  }

  /// Merges the layers of the middle axis, as many at a time as words share a cache line.
  void across_middle(Direction direction) {
    constexpr std::uint32_t kAtOnce = 8;
    const Shape shape(direction, axes_[0], axes_[2]);
    const std::ptrdiff_t sign = is_positive(direction) ? 1 : -1;
    std::array<Plane, kAtOnce> planes;
    for (std::uint32_t first = 0; first < e_.m; first += kAtOnce) {
      const std::uint32_t layers = std::min(kAtOnce, e_.m - first);
      std::array<Word, kAtOnce> any{};
      for (std::uint32_t s = 0; s < e_.s; ++s) {
        for (std::uint32_t i = 0; i < layers; ++i) {
          planes[i][s] = faces(first + i, s, sign, sign * grid_.line_stride());
          any[i] |= planes[i][s];
        }
      }
      for (std::uint32_t i = 0; i < layers; ++i) {
        const std::uint32_t m = first + i;
        start_layer(direction, m);
        if (any[i] != 0)
          merge<true>(planes[i].data(), e_.s, grid_.line(m, 0), 1, grid_.layer_stride(), shape, m);
      }
    }
    end_layers(direction, e_.m);
  }

  /// Merges the layers of the fastest axis, which lie across the bits. The words of each slow layer
  /// are transposed, so that a bit becomes a layer.
  void across_fast(Direction direction) {
    const bool positive = is_positive(direction);
    const Shape shape(direction, axes_[1], axes_[2]);
    // Word s of layer f: planes[f * kBinarySideMax + s].
    std::vector<Word>& planes = scratch_.planes;
    planes.assign(std::size_t{kBinarySideMax} * kBinarySideMax, 0);
    Plane slab;
    Word any = 0;
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      std::uint32_t faces_left = kScatteredMax;
      for (std::uint32_t m = 0; m < e_.m; ++m) {
        slab[m] = faces_along(m, s, positive);
        any |= slab[m];
        for (Word left = slab[m]; left != 0 && faces_left != 0; left &= left - 1, --faces_left) {
          planes[static_cast<std::size_t>(std::countr_zero(left)) * kBinarySideMax + s] |= Word{1}
                                                                                           << m;
        }
      }
      if (faces_left != 0) continue;
      // There are too many faces to place one by one.
      std::fill(slab.begin() + e_.m, slab.end(), 0);
      transpose_bits(slab.data());
      for (std::uint32_t f = 0; f < e_.f; ++f) planes[f * kBinarySideMax + s] = slab[f];
    }
    for (std::uint32_t f = 0; f < e_.f; ++f) {
      start_layer(direction, f);
      if ((any >> f & 1) == 0) continue;
      merge<false>(planes.data() + f * kBinarySideMax, e_.s, grid_.origin() + f,
                   grid_.line_stride(), grid_.layer_stride(), shape, f);
    }
    end_layers(direction, e_.f);
  }
  static constexpr std::uint32_t kScatteredMax = 192;  // about the cost of a transposition

  /// Returns the faces of line m, s towards the next or the previous voxel of the same line.
  Word faces_along(std::uint32_t m, std::uint32_t s, bool positive) const {
    const std::size_t word = word_at(m, s);
    // Bit 0: opaque beyond, bit 2: transparent.
    const unsigned ends = mask_.ends[word] >> (positive ? 1 : 0);
    const auto moved = [&](Word w, bool end) {
      return positive ? w >> 1 | Word{end} << (e_.f - 1) : w << 1 | Word{end};
    };
    const Word shown =
        own_[word] & ~moved(hiding(word), (ends & (kTransparent && kOne ? 5u : 1u)) != 0);
    if constexpr (!kTransparent || kOne) return shown;
    const Word beside = moved(own_[word], (ends & 4) != 0);
    if ((shown & beside) == 0) return shown;
    const Voxel* const line = grid_.line(m, s);
    return shown & (~beside | differing_bits(line, line + (positive ? 1 : -1), e_.f));
  }

  Material material_of(Voxel voxel) const {
    if constexpr (kOne) return one_material_;
    if constexpr (sizeof(Voxel) == 1) return materials_[voxel];
    return voxel;
  }

  /// Returns how many of `count` voxels from `at` on equal `voxel`, before the first that differs.
  template <bool kContiguous>
  static std::uint32_t equal_run(const Voxel* at, std::ptrdiff_t stride, std::uint32_t count,
                                 Voxel voxel) {
    if constexpr (kOne) return count;
    if constexpr (kContiguous) return equal_prefix(at, count, voxel);
    std::uint32_t i = 0;
    while (i < count && at[i * stride] == voxel) ++i;
    return i;
  }

  /// Covers the set bits of a plane with rectangles, and clears the plane's later words. `at` is
  /// the voxel of bit 0 of word 0.
  template <bool kContiguous>
  void merge(Word* plane, std::uint32_t words, const Voxel* at, std::ptrdiff_t bit_stride,
             std::ptrdiff_t word_stride, const Shape& shape, std::uint32_t layer) {
    Quad* out = scratch_.quads.data() + count_;
    const std::uint64_t base = shape.base | std::uint64_t{layer} << shape.layer_shift;
    for (std::uint32_t w = 0; w < words; ++w, at += word_stride) {
      Word bits = plane[w];
      while (bits != 0) {
        const auto from = static_cast<std::uint32_t>(std::countr_zero(bits));
        const Voxel* const first = at + from * bit_stride;
        const Voxel voxel = kOne ? Voxel{} : *first;
        const std::uint32_t length = equal_run<kContiguous>(
            first, bit_stride, static_cast<std::uint32_t>(std::countr_one(bits >> from)), voxel);
        const Word run = low_bits(length) << from;
        bits ^= run;
        const Voxel* above = first + word_stride;
        std::uint32_t end = w + 1;
        for (; end < words && (plane[end] & run) == run; ++end, above += word_stride) {
          if (equal_run<kContiguous>(above, bit_stride, length, voxel) != length) break;
          plane[end] ^= run;
        }
        *out++ = {base | std::uint64_t{from} << shape.bit_shift |
                  std::uint64_t{w} << shape.word_shift |
                  std::uint64_t{length - 1} << shape.bits_shift |
                  std::uint64_t{end - w - 1} << shape.words_shift |
                  std::uint64_t{material_of(voxel)} << 38};
      }
    }
    count_ = static_cast<std::uint32_t>(out - scratch_.quads.data());
  }

  /// Records where a layer's quads start, and reserves room for its greatest number of quads.
  void start_layer(Direction direction, std::uint32_t layer) {
    out_.first[static_cast<std::size_t>(direction) * kSideMax + layer] = count_;
    const std::size_t most = std::size_t{count_} + kBinarySideMax * kBinarySideMax;
    if (scratch_.quads.size() < most)
      scratch_.quads.resize(std::max(most, 2 * scratch_.quads.size()));
  }
  void end_layers(Direction direction, std::uint32_t layers) {
    const auto first = out_.first.begin() + static_cast<std::ptrdiff_t>(direction) * kSideMax;
    std::fill(first + layers, first + kSideMax, count_);
  }

  const Grid& grid_;
  const Material* materials_;
  const OccupancyMask& mask_;
  OrderedExtent e_;
  std::array<Axis, 3> axes_;
  const Word* own_;
  const Word* opaque_;
  Material one_material_;
  BinaryScratch& scratch_;
  QuadLayers& out_;
  std::uint32_t count_ = 0;
};

template <bool kTransparent, class Grid>
void run_pass(const Grid& grid, const Material* materials, const OccupancyMask& mask, bool any,
              bool one, BinaryScratch& scratch, QuadLayers& out) {
  if (!any) {
    out.clear();
  } else if (one) {
    Pass<Grid, kTransparent, true>(grid, materials, mask, scratch, out).run();
  } else {
    Pass<Grid, kTransparent, false>(grid, materials, mask, scratch, out).run();
  }
}

template <class Grid>
void mesh(const Grid& grid, const Material* materials, const OccupancyMask& mask,
          BinaryScratch& scratch, ChunkMesh& out) {
  const OrderedExtent e = grid.sides();
  RUNSTONE_ASSERT(e.f <= kBinarySideMax && e.m <= kBinarySideMax && e.s <= kBinarySideMax);
  RUNSTONE_ASSERT(mask.opaque.size() == std::size_t{e.m + 2} * (e.s + 2));
  run_pass<false>(grid, materials, mask, mask.any_opaque, mask.one_opaque, scratch, out.opaque);
  run_pass<true>(grid, materials, mask, mask.any_transparent, mask.one_transparent, scratch,
                 out.transparent);
}

}  // namespace

void mesh_grid(const DenseGrid& grid, const OccupancyMask& mask, BinaryScratch& scratch,
               ChunkMesh& out) {
  mesh(grid, nullptr, mask, scratch, out);
}

void mesh_volume(const PaletteVolume& volume, BinaryScratch& scratch, ChunkMesh& out) {
  mesh(volume.grid, volume.palette.materials().data(), volume.mask, scratch, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone::reference
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace runstone::reference {

HWY_EXPORT(mesh_grid);
HWY_EXPORT(mesh_volume);

void mesh_binary_greedy(const DenseGrid& grid, const OccupancyMask& mask, BinaryScratch& scratch,
                        ChunkMesh& out) {
  HWY_DYNAMIC_DISPATCH(mesh_grid)(grid, mask, scratch, out);
}

void mesh_binary_greedy(const PaletteVolume& volume, BinaryScratch& scratch, ChunkMesh& out) {
  HWY_DYNAMIC_DISPATCH(mesh_volume)(volume, scratch, out);
}

void mesh_binary_greedy(const DenseGrid& grid, const VisibilityTable& visibility,
                        BinaryScratch& scratch, ChunkMesh& out) {
  occupancy_of(grid, visibility, scratch.mask);
  mesh_binary_greedy(grid, scratch.mask, scratch, out);
}

void mesh_binary_greedy(const RunChunk& chunk, const GridNeighbours& neighbours,
                        const VisibilityTable& visibility, BinaryScratch& scratch, ChunkMesh& out) {
  if (decode_palette(chunk, neighbours, visibility, scratch.volume))
    return mesh_binary_greedy(scratch.volume, scratch, out);
  decode(chunk, neighbours, scratch.volume.layer, scratch.grid);
  mesh_binary_greedy(scratch.grid, visibility, scratch, out);
}

}  // namespace runstone::reference
#endif
