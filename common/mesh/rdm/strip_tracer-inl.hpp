// StripTracer: traces the strips of one side of a layer in the rows that differ from their previous
// row. It closes the strips that end there and opens those that begin. All other strips continue.
// Highway includes this file once per instruction set, outside of any namespace.
#if defined(RUNSTONE_MESH_RDM_STRIP_TRACER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_MESH_RDM_STRIP_TRACER_INL
#undef RUNSTONE_MESH_RDM_STRIP_TRACER_INL
#else
#define RUNSTONE_MESH_RDM_STRIP_TRACER_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "common/mesh/rdm/quad_emitter-inl.hpp"
#include "common/mesh/rdm/row_strips.hpp"
#include "common/mesh/rdm/strip_lanes-inl.hpp"
#include "common/mesh/rdm/sweep_input.hpp"
#include "common/mesh/rdm/sweep_state.hpp"
#include "common/runs/bit_row.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

/// Traits: a SweepTraits.
template <class Traits>
class StripTracer {
  using Lanes = typename Traits::Lanes;
  using IndexLanes = typename Traits::IndexLanes;
  using Row = typename Traits::Row;
  using Index = typename Traits::Index;
  using Strips = RowStrips<Row>;
  using Emitter = QuadEmitter<Traits>;
  static constexpr bool kManyMaterials = Traits::kManyMaterials;

 public:
  /// One bit for each row in which strips may end or begin.
  using RowSet = Row;

  StripTracer(const SweepInput& input, SweepState<Row>& state)
      : in_(input), st_(state), indices_(state.template indices<Index>()), e_(input.extent) {}

  /// Traces the faces across the slowest axis of layer `layer`, which is in slot `slot`. Strips lie
  /// along a line, and the next row is the next line.
  template <Side kSide>
  void trace_slow(RowSet rows, std::uint32_t layer, unsigned slot) {
    const Row* const face = st_.face[at(kSide)][0].data();
    const std::uint32_t count = e_.m;
    const Row bottom = face[count - 1];
    if (rows == 0 && bottom == 0) return;
    const Row* const cut_fast = st_.cut_fast[slot].data();
    const Row* const cut_mid = st_.cut_mid[slot].data();
    const Emitter out(in_, kSide, indices_[slot].data());
    Quad* const open = st_.open[at(kSide)].data();
    if (most(rows)) {
      compare_along({face, cut_fast, face - 1, cut_fast - 1, cut_mid});
      const Row* const closing = st_.closing.data();
      const Row* const opening = st_.opening.data();
      const Row* const start = st_.start.data();
      for (; rows != 0; rows &= rows - 1) {
        const std::uint32_t m = lowest_bit(rows);
        out.close_strips(closing[m], open, layer, m);
        out.open_strips(opening[m], start[m], open, layer, m);
      }
    }
    for (; rows != 0; rows &= rows - 1) {
      const std::uint32_t m = lowest_bit(rows);
      const Strips now = strips_along<Row>(face[m], cut_at(cut_fast + m));
      const Strips before =
          m == 0 ? Strips{} : strips_along<Row>(face[m - 1], cut_at(cut_fast + m - 1));
      const Row x = changed<Row>(now, before, cut_at(cut_mid + m));
      out.close_strips(ends_with(before, x), open, layer, m);
      out.open_strips(ends_with(now, x), now.start, open, layer, m);
    }
    const Strips over = strips_along<Row>(bottom, cut_at(cut_fast + count - 1));
    out.close_strips(over.end, open, layer, count);
  }

  /// Traces the faces across the middle axis in layer s. Strips lie along a line, and the next row
  /// is the same line of the next layer.
  template <Side kSide>
  void trace_middle(RowSet rows, std::uint32_t s, LayerPair layers) {
    if (rows == 0) return;
    const Row* const face = st_.face[at(kSide)][layers.current].data();
    const Row* const face_before = st_.face[at(kSide)][layers.previous].data();
    const Row* const cut_fast = st_.cut_fast[layers.current].data();
    const Row* const cut_fast_before = st_.cut_fast[layers.previous].data();
    const Row* const cut_slow = st_.cut_slow.data();
    const Emitter out(in_, kSide, indices_[layers.current].data());
    Quad* const open = st_.open[at(kSide)].data();
    Row* const closing = st_.closing.data();
    Row* const opening = st_.opening.data();
    Row* const start = st_.start.data();
    Place* const closed = st_.closed.data();
    Place* const opened = st_.opened.data();
    Place* closed_end = closed;
    Place* opened_end = opened;
    const bool found = most(rows);
    if (found) compare_along({face, cut_fast, face_before, cut_fast_before, cut_slow});
    for (; rows != 0; rows &= rows - 1) {
      const std::uint32_t m = lowest_bit(rows);
      if (!found) {
        const Strips now = strips_along<Row>(face[m], cut_at(cut_fast + m));
        const Strips before = strips_along<Row>(face_before[m], cut_at(cut_fast_before + m));
        const Row x = changed<Row>(now, before, cut_at(cut_slow + m));
        closing[m] = ends_with(before, x);
        opening[m] = ends_with(now, x);
        start[m] = now.start;
      }
      closed_end = write_places(closing[m], m, closed_end);
      opened_end = write_places(opening[m], m, opened_end);
    }
    for (const Place* place = closed; place != closed_end; ++place) {
      out.close(open[*place], *place / kRowBits<Row>, s);
    }
    for (const Place* place = opened; place != opened_end; ++place) {
      const std::uint32_t m = *place / kRowBits<Row>;
      const unsigned end = *place % kRowBits<Row>;
      const unsigned begin = highest_bit(start[m] & (~Row{0} >> (kRowBits<Row> - 1 - end)));
      open[*place] = out.open({m, begin, end - begin + 1, s}, m, begin);
    }
  }

  /// Traces the faces across the fastest axis in layer s: every bit is a layer of its own. Strips
  /// run along the slowest axis, one a bit: a face that appears begins a strip, and a face that
  /// disappears ends one. Strips that end side by side in neighbouring rows are one quad if they
  /// began together and are of one material.
  template <Side kSide>
  void trace_fast(RowSet rows, std::uint32_t s, LayerPair layers) {
    if (rows == 0) return;
    const Row* const face = st_.face[at(kSide)][layers.current].data();
    const Row* const face_before = st_.face[at(kSide)][layers.previous].data();
    const Row* const cut_mid_before = st_.cut_mid[layers.previous].data();
    const Row* const cut_slow = st_.cut_slow.data();
    const Emitter out(in_, kSide, indices_[layers.previous].data());
    std::uint8_t* const start_layer = st_.start_layer[at(kSide) - at(Side::fast_neg)].data();
    Row* const joins_previous = st_.joins_previous.data();
    Place* const closed = st_.closed.data();
    Place* closed_end = closed;
    Row above = 0;
    std::uint32_t next = 0;
    for (RowSet left = rows; left != 0; left &= left - 1) {
      const std::uint32_t m = lowest_bit(left);
      const Row closing = face_before[m] & (~face[m] | cut_at(cut_slow + m));
      joins_previous[m] = m == next ? above & ~cut_at(cut_mid_before + m) : Row{0};
      closed_end = write_places(closing, m, closed_end);
      above = closing;
      next = m + 1;
    }
    for (const Place* place = closed; place != closed_end; ++place) {
      const std::uint32_t m = *place / kRowBits<Row>;
      const unsigned bit = *place % kRowBits<Row>;
      const std::uint32_t first = start_layer[*place];
      // Row 0 has no row above it and may read any byte.
      const bool joins = (joins_previous[m] >> bit & 1) != 0 &&
                         start_layer[*place - (m == 0 ? 0 : kRowBits<Row>)] == first;
      out.close_or_join(out.open({bit, first, s - first, m}, m, bit), bit, m + 1, joins);
    }
    for (RowSet left = rows; left != 0; left &= left - 1) {
      const std::uint32_t m = lowest_bit(left);
      const Row opening = face[m] & (~face_before[m] | cut_at(cut_slow + m));
      IndexLanes::template put<Row>(opening, static_cast<std::uint8_t>(s),
                                    start_layer + std::size_t{m} * kRowBits<Row>);
    }
  }

 private:
  static HWY_INLINE Row cut_at(const Row* cut) { return kManyMaterials ? *cut : Row{0}; }

  /// Returns true if so many rows change that comparing all rows at once costs less than comparing
  /// these one by one.
  bool most([[maybe_unused]] RowSet rows) const {
    if constexpr (Lanes::kLanes == 1) {
      return false;
    } else {
      return bit_count(rows) * Lanes::kLanes > e_.m;
    }
  }

  /// Rows of strips and their cuts, strips and cuts of the previous rows, and the bits whose
  /// material differs between them.
  struct Lines {
    const Row *face, *cut, *face_before, *cut_before, *differs;
  };
  /// Finds the strips that close and open, for all rows.
  void compare_along(const Lines& in) {
    using Vectors = StripLanes<Traits>;
    Row* const closing = st_.closing.data();
    Row* const opening = st_.opening.data();
    Row* const start = st_.start.data();
    for_rows<Lanes>(e_.m, [=](std::uint32_t m) {
      const Vectors now = Vectors::along(in.face + m, in.cut + m);
      const Vectors before = Vectors::along(in.face_before + m, in.cut_before + m);
      const auto x = Vectors::changed(now, before, in.differs + m);
      Lanes::store(before.ends_with(x), closing + m);
      Lanes::store(now.ends_with(x), opening + m);
      Lanes::store(now.start, start + m);
    });
  }

  /// The places of bits are written to a list first and visited afterwards. Then one loop visits
  /// the places of all rows, and its end is predictable. Values written behind the last place are
  /// ignored.
  using Place = std::uint16_t;
  static HWY_INLINE Place* write_places(Row bits, std::uint32_t row, Place* to) {
    const std::uint32_t base = row * kRowBits<Row>;
    Place* const end = to + bit_count(bits);
    do {
      for (unsigned i = 0; i < 2; ++i, ++to, bits &= bits - 1) {
        *to = static_cast<Place>(base + lowest_bit(bits));
      }
    } while (bits != 0);
    return end;
  }

  const SweepInput& in_;
  SweepState<Row>& st_;
  typename SweepState<Row>::template Indices<Index>& indices_;
  const OrderedExtent e_;
};

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
