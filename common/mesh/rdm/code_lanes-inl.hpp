// Codes of voxels side by side: filling a run of them, and comparing a row of them with another into bits.
// Included once per instruction set, inside no namespace.
#if defined(RUNSTONE_MESH_RDM_CODE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_MESH_RDM_CODE_LANES_INL
#undef RUNSTONE_MESH_RDM_CODE_LANES_INL
#else
#define RUNSTONE_MESH_RDM_CODE_LANES_INL
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/runs/bit_row.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A code at a time: the plain path.
struct PlainCodes {
  /// Codes that fill() may write behind `stop`.
  template <class C>
  static constexpr unsigned kBehind = 0;

  template <class C>
  static void fill(C* from, const C* stop, C code) {
    for (; from < stop; ++from) *from = code;
  }

  /// Writes `value` where a bit of the row is set.
  template <class Row>
  static void put(Row row, std::uint8_t value, std::uint8_t* to) {
    for (; row != 0; row &= row - 1) to[lowest_bit(row)] = value;
  }

  /// As many codes as a row has bits.
  template <class Row, class C>
  class Line {
   public:
    static Line at(const C* codes) { return Line(codes); }
    /// Bit i: whether code i is not 0.
    Row solid() const {
      return gather([this](unsigned i) { return codes_[i] != 0; });
    }
    /// Bit i: whether code i is a transparent one.
    Row transparent() const {
      return gather([this](unsigned i) { return codes_[i] >> (sizeof(C) * 8 - 1) != 0; });
    }
    /// Bit i: whether the two have another code there.
    friend Row differing(const Line& a, const Line& b) {
      return gather([&](unsigned i) { return a.codes_[i] != b.codes_[i]; });
    }

   private:
    explicit Line(const C* codes) : codes_(codes) {}
    template <class F>
    static Row gather(F&& bit) {
      Row row = 0;
      for (unsigned i = 0; i < kRowBits<Row>; ++i) row |= Row{bit(i)} << i;
      return row;
    }
    const C* codes_;
  };
};

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE
/// A vector of codes at a time.
struct VectorCodes {
  template <class C>
  using D = hn::CappedTag<C, 64>;
  template <class C>
  static constexpr unsigned kBehind = hn::MaxLanes(D<C>());

  template <class C>
  static HWY_INLINE void fill(C* from, const C* stop, C code) {
    const D<C> d;
    const auto v = hn::Set(d, code);
    do {
      hn::StoreU(v, d, from);
      from += kBehind<C>;
    } while (from < stop);
  }

  template <class Row>
  static HWY_INLINE void put(Row row, std::uint8_t value, std::uint8_t* to) {
    const D<std::uint8_t> d;
    const auto v = hn::Set(d, value);
    for (unsigned i = 0; i < kRowBits<Row>; i += kBehind<std::uint8_t>) {
      const auto bits = static_cast<std::uint64_t>(row >> i);
      std::uint8_t bytes[8];
      std::memcpy(bytes, &bits, sizeof bytes);
      hn::BlendedStore(v, hn::LoadMaskBits(d, bytes), d, to + i);
    }
  }

  template <class Row, class C>
  class Line {
   public:
    static HWY_INLINE Line at(const C* codes) {
      Line line;
      for (unsigned i = 0; i < kParts; ++i)
        line.part_[i] = hn::LoadU(D<C>(), codes + i * kBehind<C>);
      return line;
    }
    HWY_INLINE Row solid() const {
      return gather([this](unsigned i) { return hn::Ne(part_[i], hn::Zero(D<C>())); });
    }
    HWY_INLINE Row transparent() const {
      const hn::RebindToSigned<D<C>> s;
      return gather([&](unsigned i) {
        return hn::RebindMask(D<C>(), hn::Lt(hn::BitCast(s, part_[i]), hn::Zero(s)));
      });
    }
    friend HWY_INLINE Row differing(const Line& a, const Line& b) {
      return gather([&](unsigned i) { return hn::Ne(a.part_[i], b.part_[i]); });
    }

   private:
    static constexpr unsigned kParts = kRowBits<Row> / kBehind<C>;
    template <class F>
    static HWY_INLINE Row gather(F&& mask_of) {
      Row row = 0;
      for (unsigned i = 0; i < kParts; ++i) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(D<C>(), mask_of(i), bytes);
        std::uint64_t bits = 0;
        std::memcpy(&bits, bytes, sizeof bits);
        row |= Row{bits} << (i * kBehind<C>);
      }
      return row;
    }
    hn::Vec<D<C>> part_[kParts];
  };
};
#else
using VectorCodes = PlainCodes;
#endif

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
