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

#include "common/mesh/rdm/bit_row.hpp"
#include "common/mesh/rdm/material_codes.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A code at a time, or eight bytes in a word: the plain path.
struct PlainCodes {
  /// Codes that fill() may write behind `stop`.
  template <class C>
  static constexpr unsigned kBehind = 0;

  template <class C>
  static void fill(C* from, const C* stop, C code) {
    for (; from < stop; ++from) *from = code;
  }
  /// Bit i: whether a[i] is not b[i], for as many i as a row has bits.
  template <class Row, class C>
  static Row differing(const C* a, const C* b) {
    return gather<Row>([a, b](unsigned i) { return a[i] != b[i]; });
  }
  /// Bit i: whether a[i] is not 0.
  template <class Row, class C>
  static Row solid(const C* a) {
    return gather<Row>([a](unsigned i) { return a[i] != 0; });
  }
  /// Bit i: whether a[i] is a transparent code.
  template <class Row, class C>
  static Row transparent(const C* a) {
    return gather<Row>([a](unsigned i) { return a[i] >> (sizeof(C) * 8 - 1) != 0; });
  }

 private:
  template <class Row, class F>
  static Row gather(F&& bit) {
    Row row = 0;
    for (unsigned i = 0; i < kRowBits<Row>; ++i) row |= Row{bit(i)} << i;
    return row;
  }
};

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
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
  template <class Row, class C>
  static HWY_INLINE Row differing(const C* a, const C* b) {
    const D<C> d;
    return gather<Row, C>([=](unsigned i) { return hn::Ne(hn::LoadU(d, a + i), hn::LoadU(d, b + i)); });
  }
  template <class Row, class C>
  static HWY_INLINE Row solid(const C* a) {
    const D<C> d;
    return gather<Row, C>([=](unsigned i) { return hn::Ne(hn::LoadU(d, a + i), hn::Zero(d)); });
  }
  template <class Row, class C>
  static HWY_INLINE Row transparent(const C* a) {
    const D<C> d;
    const hn::RebindToSigned<D<C>> s;
    return gather<Row, C>([=](unsigned i) {
      return hn::RebindMask(d, hn::Lt(hn::BitCast(s, hn::LoadU(d, a + i)), hn::Zero(s)));
    });
  }

 private:
  template <class Row, class C, class F>
  static HWY_INLINE Row gather(F&& mask_at) {
    Row row = 0;
    for (unsigned i = 0; i < kRowBits<Row>; i += kBehind<C>) {
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(D<C>(), mask_at(i), bytes);
      std::uint64_t bits = 0;
      std::memcpy(&bits, bytes, sizeof bits);
      row |= Row{bits} << i;
    }
    return row;
  }
};
#else
using VectorCodes = PlainCodes;
#endif

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
