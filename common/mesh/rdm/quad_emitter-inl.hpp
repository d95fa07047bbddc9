// QuadEmitter: turns the strips of one side into quads. A quad is packed when its strip opens and
// put into the bucket of its layer when the strip closes. Highway includes this file once per
// instruction set, outside of any namespace.
#if defined(RUNSTONE_MESH_RDM_QUAD_EMITTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_MESH_RDM_QUAD_EMITTER_INL
#undef RUNSTONE_MESH_RDM_QUAD_EMITTER_INL
#else
#define RUNSTONE_MESH_RDM_QUAD_EMITTER_INL
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "common/core/ids.hpp"
#include "common/mesh/quad.hpp"
#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/mesh/rdm/quad_buckets.hpp"
#include "common/mesh/rdm/quad_shape.hpp"
#include "common/mesh/rdm/sweep_input.hpp"
#include "common/runs/bit_row.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

/// A new value is made for each side of each layer, so that the compiler can keep it in registers
/// while bytes are written. Traits: a SweepTraits.
template <class Traits>
class QuadEmitter {
  using Row = typename Traits::Row;
  using Index = typename Traits::Index;
  static constexpr bool kManyMaterials = Traits::kManyMaterials;

 public:
  /// `layer`: the palette indices of the strips' voxels.
  HWY_INLINE QuadEmitter(const SweepInput& input, Side side, const Index* layer)
      : shape_(input.shape[at(side)]),
        opaque_(
            (!kManyMaterials && input.palette->has_transparent() ? input.transparent : input.opaque)
                ->of(input.direction[at(side)])),
        transparent_(input.transparent->of(input.direction[at(side)])),
        layer_(layer),
        line_size_(input.extent.f),
        palette_(input.palette),
        mixed_(kManyMaterials && input.palette->has_transparent()),
        single_(kManyMaterials ? kEmpty : input.palette->single()) {}

  /// Returns the quad of a strip whose material is that of bit `bit` of row `line`.
  HWY_INLINE Quad open(const Strip& strip, [[maybe_unused]] std::uint32_t line,
                       [[maybe_unused]] unsigned bit) const {
    if constexpr (!kManyMaterials) {
      return shape_.open(strip, single_);
    } else {
      const Index index = layer_[line * line_size_ + bit];
      Quad quad = shape_.open(strip, palette_->material(index));
      if (mixed_ && full_index(index) >= kTransparentBit) quad.bits ^= kTransparentQuad;
      return quad;
    }
  }
  /// Puts a quad whose strip ends before row `row`.
  HWY_INLINE void close(Quad open, std::uint32_t layer, std::uint32_t row) const {
    Quad quad = shape_.close(open, row);
    QuadBuckets::Bucket* const buckets = pass_of(quad);
    QuadBuckets::put(buckets[layer], quad);
  }
  /// Puts a quad whose strip ends before row `row`, or, if `joins`, adds one row to the quad that
  /// was put last into that layer. Requires a quad of one row.
  HWY_INLINE void close_or_join(Quad open, std::uint32_t layer, std::uint32_t row,
                                bool joins) const {
    Quad quad = shape_.close(open, row);
    QuadBuckets::Bucket& bucket = pass_of(quad)[layer];
    if (bucket.count == bucket.room) QuadBuckets::grow(bucket);
    // The code has no branch here, because the choice is unpredictable.
    bucket.count -= joins ? 1 : 0;
    Quad* const to = bucket.quads.get() + bucket.count++;
    *to = joins ? shape_.with_row_more(*to) : quad;
  }

  /// Closes the strips of a line that end at the bits of `closing`, before row `row`. `open`: the
  /// open quads of the line, by end.
  HWY_INLINE void close_strips(Row closing, const Quad* open, std::uint32_t layer,
                               std::uint32_t row) const {
    if (closing == 0) return;
    if (mixed_) {
      for (; closing != 0; closing &= closing - 1) close(open[lowest_bit(closing)], layer, row);
      return;
    }
    QuadBuckets::Bucket& bucket = opaque_[layer];
    Quad* const to = QuadBuckets::reserve(bucket, kRowBits<Row>);
    Quad* next = to;
    for (; closing != 0; closing &= closing - 1)
      *next++ = shape_.close(open[lowest_bit(closing)], row);
    bucket.count += static_cast<std::uint32_t>(next - to);
  }
  /// Opens the strips that end at the bits of `opening` and begin at bits of `start`, in row `row`.
  /// Their material is that of the same row.
  HWY_INLINE void open_strips(Row opening, Row start, Quad* open, std::uint32_t layer,
                              std::uint32_t row) const {
    for (; opening != 0; opening &= opening - 1) {
      const unsigned end = lowest_bit(opening);
      const unsigned begin = highest_bit(start & (opening ^ (opening - 1)));
      open[end] = this->open({layer, begin, end - begin + 1, row}, row, begin);
    }
  }

 private:
  /// Returns the buckets of the quad's pass, and clears the mark of the quad.
  HWY_INLINE QuadBuckets::Bucket* pass_of(Quad& quad) const {
    if (!kManyMaterials || (quad.bits & kTransparentQuad) == 0) return opaque_;
    quad.bits ^= kTransparentQuad;
    return transparent_;
  }

  QuadShape shape_;
  QuadBuckets::Bucket* opaque_;
  QuadBuckets::Bucket* transparent_;
  const Index* layer_;
  std::uint32_t line_size_;
  const ChunkPalette* palette_;
  bool mixed_;       // some materials are transparent and others are not
  Material single_;  // the material, if there is only one
};

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
