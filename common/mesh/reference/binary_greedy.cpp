#include "common/mesh/reference/binary_greedy.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "common/core/assert.hpp"
#include "common/mesh/reference/bit_matrix.hpp"
#include "common/mesh/reference/row_compare.hpp"

namespace runstone::reference {
namespace {

using Word = std::uint64_t;
using Plane = std::array<Word, kBinarySideMax>;

/// Packs the quads of one direction; `bit_axis` is the one the words' bits lie along.
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

/// One pass over the faces of one visibility class.
class Pass {
 public:
  Pass(const DenseGrid& grid, const OccupancyMask& mask, bool transparent, BinaryScratch& scratch,
       QuadLayers& out)
      : grid_(grid),
        mask_(mask),
        e_(grid.sides()),
        axes_(axes_of(grid.order())),
        own_(transparent ? mask.transparent : mask.opaque),
        transparent_(transparent),
        one_(transparent ? mask.one_transparent : mask.one_opaque),
        scratch_(scratch),
        out_(out) {}

  void run() {
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const Axis axis = axis_of(direction);
      if (axis == axes_[0]) {
        across_bits(direction);
      } else {
        across_words(direction, axis == axes_[1]);
      }
    }
    out_.first[kDirectionCount * kSideMax] = count_;
    out_.quads.assign(scratch_.quads.begin(), scratch_.quads.begin() + count_);
  }

 private:
  std::size_t word_at(std::uint32_t m, std::uint32_t s) const {
    return (m + 1) + std::size_t{e_.m + 2} * (s + 1);
  }

  /// What hides faces of this pass whatever it is made of.
  Word hiding(std::size_t word) const {
    return transparent_ ? mask_.opaque[word] | (one_ ? mask_.transparent[word] : 0) : mask_.opaque[word];
  }

  /// Faces of line m, s towards the line `step` further: a word of bits along the fastest axis.
  Word faces(std::uint32_t m, std::uint32_t s, std::ptrdiff_t word_step, std::ptrdiff_t voxel_step) const {
    const std::size_t word = word_at(m, s);
    const std::size_t other = word + static_cast<std::size_t>(word_step);
    const Word shown = own_[word] & ~hiding(other);
    if (!transparent_ || one_ || (shown & mask_.transparent[other]) == 0) return shown;
    const Material* const line = grid_.line(m, s);
    return shown & (~mask_.transparent[other] | differing_bits(line, line + voxel_step, e_.f));
  }

  /// Layers whose words lie in them: of the middle or the slowest axis.
  void across_words(Direction direction, bool middle) {
    const std::uint32_t layers = middle ? e_.m : e_.s;
    const std::uint32_t words = middle ? e_.s : e_.m;
    const Shape shape(direction, axes_[0], middle ? axes_[2] : axes_[1]);
    const std::ptrdiff_t sign = is_positive(direction) ? 1 : -1;
    const std::ptrdiff_t word_step = sign * (middle ? 1 : static_cast<std::ptrdiff_t>(e_.m) + 2);
    const std::ptrdiff_t voxel_step = sign * (middle ? grid_.line_stride() : grid_.layer_stride());
    const std::ptrdiff_t layer_stride = middle ? grid_.line_stride() : grid_.layer_stride();
    const std::ptrdiff_t line_stride = middle ? grid_.layer_stride() : grid_.line_stride();
    Plane plane;
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
      start_layer(direction, layer);
      Word any = 0;
      for (std::uint32_t i = 0; i < words; ++i) {
        plane[i] = middle ? faces(layer, i, word_step, voxel_step) : faces(i, layer, word_step, voxel_step);
        any |= plane[i];
      }
      if (any != 0) {
        merge<true>(plane.data(), words, grid_.origin() + layer * layer_stride, 1, line_stride, shape, layer);
      }
    }
    end_layers(direction, layers);
  }

  /// Layers across the bits: each slow layer's words are turned, so that a bit becomes a layer.
  void across_bits(Direction direction) {
    const bool positive = is_positive(direction);
    const Shape shape(direction, axes_[1], axes_[2]);
    std::vector<Word>& planes = scratch_.planes;  // word s of layer f: planes[f * kBinarySideMax + s]
    planes.assign(std::size_t{kBinarySideMax} * kBinarySideMax, 0);
    const Word before_bit = transparent_ ? 5 : 1;  // of `ends`; voxels of one transparent material hide too
    Plane slab;
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      std::uint32_t faces_left = kScatteredMax;
      for (std::uint32_t m = 0; m < e_.m; ++m) {
        const std::size_t word = word_at(m, s);
        const Word ends = mask_.ends[word] & (before_bit << (positive ? 1 : 0));
        const auto step = [&](Word w, bool end) {
          return positive ? w >> 1 | Word{end} << (e_.f - 1) : w << 1 | Word{end};
        };
        const bool end_hides = transparent_ && !one_ ? (ends & 3) != 0 : ends != 0;
        Word shown = own_[word] & ~step(hiding(word), end_hides);
        if (transparent_ && !one_) {
          const Word beside = step(mask_.transparent[word], ends > 3);
          if ((shown & beside) != 0) {
            const Material* const line = grid_.line(m, s);
            shown &= ~beside | differing_bits(line, line + (positive ? 1 : -1), e_.f);
          }
        }
        slab[m] = shown;
        for (Word left = shown; left != 0 && faces_left != 0; left &= left - 1, --faces_left) {
          planes[static_cast<std::size_t>(std::countr_zero(left)) * kBinarySideMax + s] |= Word{1} << m;
        }
      }
      if (faces_left != 0) continue;
      // Too many faces to place one by one.
      std::fill(slab.begin() + e_.m, slab.end(), 0);
      transpose_bits(slab.data());
      for (std::uint32_t f = 0; f < e_.f; ++f) planes[f * kBinarySideMax + s] = slab[f];
    }
    for (std::uint32_t f = 0; f < e_.f; ++f) {
      start_layer(direction, f);
      merge<false>(planes.data() + f * kBinarySideMax, e_.s, grid_.origin() + f, grid_.line_stride(),
                   grid_.layer_stride(), shape, f);
    }
    end_layers(direction, e_.f);
  }
  static constexpr std::uint32_t kScatteredMax = 192;  // about what a transposition costs

  /// Materials from `at` on that equal `material`, `count` at most.
  template <bool kContiguous>
  static std::uint32_t equal_run(const Material* at, std::ptrdiff_t stride, std::uint32_t count,
                                 Material material) {
    if constexpr (kContiguous) return equal_prefix(at, count, material);
    std::uint32_t i = 0;
    while (i < count && at[i * stride] == material) ++i;
    return i;
  }

  /// Covers the set bits of a plane by rectangles. `at` is the voxel of bit 0 of word 0.
  template <bool kContiguous>
  void merge(Word* plane, std::uint32_t words, const Material* at, std::ptrdiff_t bit_stride,
             std::ptrdiff_t word_stride, const Shape& shape, std::uint32_t layer) {
    Quad* out = scratch_.quads.data() + count_;
    const std::uint64_t base = shape.base | std::uint64_t{layer} << shape.layer_shift;
    for (std::uint32_t w = 0; w < words; ++w, at += word_stride) {
      Word bits = plane[w];
      while (bits != 0) {
        const auto from = static_cast<std::uint32_t>(std::countr_zero(bits));
        auto length = static_cast<std::uint32_t>(std::countr_one(bits >> from));
        const Material* const voxel = at + from * bit_stride;
        const Material material = *voxel;
        if (!one_) length = equal_run<kContiguous>(voxel, bit_stride, length, material);
        const Word run = low_bits(length) << from;
        bits ^= run;
        const Material* above = voxel + word_stride;
        std::uint32_t end = w + 1;
        for (; end < words && (plane[end] & run) == run; ++end, above += word_stride) {
          if (!one_ && equal_run<kContiguous>(above, bit_stride, length, material) != length) break;
          plane[end] ^= run;
        }
        *out++ = {base | std::uint64_t{from} << shape.bit_shift | std::uint64_t{w} << shape.word_shift |
                  std::uint64_t{length - 1} << shape.bits_shift |
                  std::uint64_t{end - w - 1} << shape.words_shift | std::uint64_t{material} << 38};
      }
    }
    count_ = static_cast<std::uint32_t>(out - scratch_.quads.data());
  }

  /// Notes where a layer's quads start and makes room for as many as it can have.
  void start_layer(Direction direction, std::uint32_t layer) {
    out_.first[static_cast<std::size_t>(direction) * kSideMax + layer] = count_;
    const std::size_t most = std::size_t{count_} + kBinarySideMax * kBinarySideMax;
    if (scratch_.quads.size() < most) scratch_.quads.resize(std::max(most, 2 * scratch_.quads.size()));
  }
  void end_layers(Direction direction, std::uint32_t layers) {
    const auto first = out_.first.begin() + static_cast<std::ptrdiff_t>(direction) * kSideMax;
    std::fill(first + layers, first + kSideMax, count_);
  }

  const DenseGrid& grid_;
  const OccupancyMask& mask_;
  OrderedExtent e_;
  std::array<Axis, 3> axes_;
  const std::vector<Word>& own_;
  bool transparent_, one_;
  BinaryScratch& scratch_;
  QuadLayers& out_;
  std::uint32_t count_ = 0;
};

}  // namespace

void mesh_binary_greedy(const DenseGrid& grid, const OccupancyMask& mask, BinaryScratch& scratch,
                        ChunkMesh& out) {
  const OrderedExtent e = grid.sides();
  RUNSTONE_ASSERT(e.f <= kBinarySideMax && e.m <= kBinarySideMax && e.s <= kBinarySideMax);
  RUNSTONE_ASSERT(mask.opaque.size() == std::size_t{e.m + 2} * (e.s + 2));
  if (mask.any_opaque) {
    Pass(grid, mask, false, scratch, out.opaque).run();
  } else {
    out.opaque.clear();
  }
  if (mask.any_transparent) {
    Pass(grid, mask, true, scratch, out.transparent).run();
  } else {
    out.transparent.clear();
  }
}

void mesh_binary_greedy(const DenseGrid& grid, const VisibilityTable& visibility, BinaryScratch& scratch,
                        ChunkMesh& out) {
  occupancy_of(grid, visibility, scratch.mask);
  mesh_binary_greedy(grid, scratch.mask, scratch, out);
}

}  // namespace runstone::reference
