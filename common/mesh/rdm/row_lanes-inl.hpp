// Rows of bits as vectors. A step takes as many rows as a vector of the machine holds. Highway
// includes this file once per instruction set, outside of any namespace.
#if defined(RUNSTONE_MESH_RDM_ROW_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_MESH_RDM_ROW_LANES_INL
#undef RUNSTONE_MESH_RDM_ROW_LANES_INL
#else
#define RUNSTONE_MESH_RDM_ROW_LANES_INL
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "common/runs/bit_row.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One row a step. It serves the plain path, and rows that are wider than a vector's lane.
template <class R>
struct OneRow {
  using Row = R;
  using V = R;
  static constexpr unsigned kLanes = 1;
  static V load(const Row* p) { return *p; }
  static void store(V v, Row* p) { *p = v; }
  static V all(Row row) { return row; }
  static V both(V a, V b) { return a & b; }
  static V either(V a, V b) { return a | b; }
  static V differing(V a, V b) { return a ^ b; }
  static V without(V a, V b) { return a & ~b; }
  static V sum(V a, V b) { return a + b; }
  static V up(V a) { return a << 1; }
  static V down(V a) { return a >> 1; }
  /// Returns a word in which bit i is set if lane i is not zero.
  static std::uint64_t any(V a) { return a != 0 ? 1 : 0; }
  /// Returns `row` in the lanes whose bit is set, and zero in the others.
  static V where(std::uint64_t lanes, Row row) { return (lanes & 1) != 0 ? row : 0; }
};

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE
/// A step takes as many rows as a vector holds.
template <class R>
struct VectorRows {
  using Row = R;
  using D = hn::CappedTag<Row, 64 / sizeof(Row)>;
  using V = hn::Vec<D>;
  static constexpr unsigned kLanes = hn::MaxLanes(D());
  static HWY_INLINE V load(const Row* p) { return hn::LoadU(D(), p); }
  static HWY_INLINE void store(V v, Row* p) { hn::StoreU(v, D(), p); }
  static HWY_INLINE V all(Row row) { return hn::Set(D(), row); }
  static HWY_INLINE V both(V a, V b) { return hn::And(a, b); }
  static HWY_INLINE V either(V a, V b) { return hn::Or(a, b); }
  static HWY_INLINE V differing(V a, V b) { return hn::Xor(a, b); }
  static HWY_INLINE V without(V a, V b) { return hn::AndNot(b, a); }
  static HWY_INLINE V sum(V a, V b) { return hn::Add(a, b); }
  static HWY_INLINE V up(V a) { return hn::ShiftLeft<1>(a); }
  static HWY_INLINE V down(V a) { return hn::ShiftRight<1>(a); }
  static HWY_INLINE std::uint64_t any(V a) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), hn::Ne(a, hn::Zero(D())), bytes);
    return bytes[0] | std::uint64_t{bytes[1]} << 8;
  }
  static HWY_INLINE V where(std::uint64_t lanes, Row row) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(lanes),
                                   static_cast<std::uint8_t>(lanes >> 8)};
    return hn::IfThenElseZero(hn::LoadMaskBits(D(), bytes), hn::Set(D(), row));
  }
};
#else
template <class R>
using VectorRows = OneRow<R>;
#endif

/// Calls step(first row) for every step of whole vectors over `count` rows. The last step may
/// extend beyond them.
template <class Lanes, class F>
HWY_INLINE void for_rows(std::uint32_t count, F&& step) {
  for (std::uint32_t m = 0; m < count; m += Lanes::kLanes) step(m);
}

/// Returns a row in which bit m < `count` is set if row m has a bit of `bit`.
template <class Lanes, class Row>
Row column_of(const Row* rows, std::uint32_t count, Row bit) {
  const auto wanted = Lanes::all(bit);
  Row column = 0;
  for_rows<Lanes>(count, [&](std::uint32_t m) {
    column |= static_cast<Row>(Lanes::any(Lanes::both(Lanes::load(rows + m), wanted))) << m;
  });
  return column & bits_below<Row>(count);
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
