// Palette indices as vectors: fills a run with an index, and compares rows of indices into bits.
// Highway includes this file once per instruction set, outside of any namespace.
#if defined(RUNSTONE_MESH_RDM_INDEX_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_MESH_RDM_INDEX_LANES_INL
#undef RUNSTONE_MESH_RDM_INDEX_LANES_INL
#else
#define RUNSTONE_MESH_RDM_INDEX_LANES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/runs/bit_row.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The plain path: one index at a time.
struct PlainIndices {
  /// Number of indices that fill() may write behind `stop`, in chunks whose lines fit a Row.
  template <class Row, class Index>
  static constexpr unsigned kBehind = 0;

  template <class Row, class Index>
  static void fill(Index* from, const Index* stop, Index index) {
    for (; from < stop; ++from) *from = index;
  }

  /// Writes `value` where a bit of the row is set.
  template <class Row>
  static void put(Row row, std::uint8_t value, std::uint8_t* to) {
    for (; row != 0; row &= row - 1) to[lowest_bit(row)] = value;
  }

  /// A line of as many indices as a row has bits.
  template <class Row, class Index>
  class Line {
   public:
    static Line at(const Index* indices) { return Line(indices); }
    /// Returns a row in which bit i is set if index i is not 0.
    Row solid() const {
      return gather([this](unsigned i) { return indices_[i] != 0; });
    }
    /// Returns a row in which bit i is set if index i is a transparent one.
    Row transparent() const {
      return gather([this](unsigned i) { return indices_[i] >> (sizeof(Index) * 8 - 1) != 0; });
    }
    /// Returns a row in which bit i is set if the two indices i differ.
    friend Row differing(const Line& a, const Line& b) {
      return gather([&](unsigned i) { return a.indices_[i] != b.indices_[i]; });
    }

   private:
    explicit Line(const Index* indices) : indices_(indices) {}
    template <class F>
    static Row gather(F&& bit) {
      Row row = 0;
      for (unsigned i = 0; i < kRowBits<Row>; ++i) row |= Row{bit(i)} << i;
      return row;
    }
    const Index* indices_;
  };
};

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE
/// A vector of indices at a time, or as many as a line has.
struct VectorIndices {
  template <class Row, class Index>
  using D = hn::CappedTag<Index, std::min(kRowBits<Row>, 64u)>;
  template <class Row, class Index>
  static constexpr unsigned kBehind = hn::MaxLanes(D<Row, Index>());

  template <class Row, class Index>
  static HWY_INLINE void fill(Index* from, const Index* stop, Index index) {
    constexpr auto kStep = static_cast<std::ptrdiff_t>(kBehind<Row, Index>);
    const D<Row, Index> d;
    const auto v = hn::Set(d, index);
    hn::StoreU(v, d, from);
    if (HWY_LIKELY(stop - from <= kStep)) return;  // most runs are shorter than a line
    do {
      from += kStep;
      hn::StoreU(v, d, from);
    } while (stop - from > kStep);
  }

  template <class Row>
  static HWY_INLINE void put(Row row, std::uint8_t value, std::uint8_t* to) {
    const D<Row, std::uint8_t> d;
    const auto v = hn::Set(d, value);
    for (unsigned i = 0; i < kRowBits<Row>; i += kBehind<Row, std::uint8_t>) {
      const auto bits = static_cast<std::uint64_t>(row >> i);
      std::uint8_t bytes[8];
      std::memcpy(bytes, &bits, sizeof bytes);
      // BlendedStore() is slower here. Without AVX-512 it writes one byte at a time, because it
      // must not write the bytes outside of its mask. With AVX-512 its masked store delays later
      // loads of these bytes. This code may write the other bytes back unchanged.
      const auto kept = hn::LoadU(d, to + i);
      hn::StoreU(hn::IfThenElse(hn::LoadMaskBits(d, bytes), v, kept), d, to + i);
    }
  }

  template <class Row, class Index>
  class Line {
    using Tag = D<Row, Index>;
    static constexpr unsigned kLanes = hn::MaxLanes(Tag());

   public:
    static HWY_INLINE Line at(const Index* indices) {
      Line line;
      for (unsigned i = 0; i < kParts; ++i) line.part_[i] = hn::LoadU(Tag(), indices + i * kLanes);
      return line;
    }
    HWY_INLINE Row solid() const {
      return gather([this](unsigned i) { return hn::Ne(part_[i], hn::Zero(Tag())); });
    }
    HWY_INLINE Row transparent() const {
      const hn::RebindToSigned<Tag> s;
      return gather([&](unsigned i) {
        return hn::RebindMask(Tag(), hn::Lt(hn::BitCast(s, part_[i]), hn::Zero(s)));
      });
    }
    friend HWY_INLINE Row differing(const Line& a, const Line& b) {
      return gather([&](unsigned i) { return hn::Ne(a.part_[i], b.part_[i]); });
    }

   private:
    static constexpr unsigned kParts = kRowBits<Row> / kLanes;
    template <class F>
    static HWY_INLINE Row gather(F&& mask_of) {
      Row row = 0;
      for (unsigned i = 0; i < kParts; ++i) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(Tag(), mask_of(i), bytes);
        std::uint64_t bits = 0;
        std::memcpy(&bits, bytes, sizeof bits);
        row |= static_cast<Row>(bits) << (i * kLanes);
      }
      return row;
    }
    hn::Vec<Tag> part_[kParts];
  };
};
#else
using VectorIndices = PlainIndices;
#endif

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
