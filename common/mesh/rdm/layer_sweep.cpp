#include "common/mesh/rdm/layer_sweep.hpp"

#include <algorithm>
#include <cstring>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/divider.hpp"

// The rest of this file is compiled once per instruction set; Highway picks one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/mesh/rdm/layer_sweep.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One row a step: the plain path, and rows wider than a vector's lane.
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
  template <int kBits>
  static V up(V a) {
    return a << kBits;
  }
  static V down(V a) { return a >> 1; }
  /// Bit i: lane i is not zero.
  static std::uint64_t any(V a) { return a != 0 ? 1 : 0; }
  /// Bit i: the highest bit of lane i.
  static std::uint64_t tops(V a) { return static_cast<std::uint64_t>(a >> (kRowBits<Row> - 1)); }
  /// `row` in the lanes whose bit is set.
  static V where(std::uint64_t lanes, Row row) { return (lanes & 1) != 0 ? row : 0; }
  /// slots[i] = value where bit i is set.
  static void mark(std::uint8_t* slots, Row bits, std::uint8_t value) {
    for (; bits != 0; bits &= bits - 1) slots[lowest_bit(bits)] = value;
  }
};

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
/// As many rows a step as a vector holds.
struct VectorRows {
  using Row = Row64;
  using D = hn::CappedTag<Row64, 8>;
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
  template <int kBits>
  static HWY_INLINE V up(V a) {
    return hn::ShiftLeft<kBits>(a);
  }
  static HWY_INLINE V down(V a) { return hn::ShiftRight<1>(a); }
  static HWY_INLINE std::uint64_t bits_of(hn::Mask<D> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), mask, bytes);
    return bytes[0];
  }
  static HWY_INLINE std::uint64_t any(V a) { return bits_of(hn::Ne(a, hn::Zero(D()))); }
  static HWY_INLINE std::uint64_t tops(V a) {
    const hn::RebindToSigned<D> d;
    return bits_of(hn::RebindMask(D(), hn::Lt(hn::BitCast(d, a), hn::Zero(d))));
  }
  static HWY_INLINE V where(std::uint64_t lanes, Row row) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(lanes)};
    return hn::IfThenElseZero(hn::LoadMaskBits(D(), bytes), hn::Set(D(), row));
  }
  static HWY_INLINE void mark(std::uint8_t* slots, Row bits, std::uint8_t value) {
    const hn::CappedTag<std::uint8_t, 64> d;
    std::uint8_t bytes[16] = {};
    std::memcpy(bytes, &bits, sizeof bits);
    for (std::size_t i = 0; i < 64; i += hn::Lanes(d)) {
      const auto mask = hn::LoadMaskBits(d, bytes + i / 8);
      hn::StoreU(hn::IfThenElse(mask, hn::Set(d, value), hn::LoadU(d, slots + i)), d, slots + i);
    }
  }
};
#else
using VectorRows = OneRow<Row64>;
#endif

/// One call of sweep_layers(). kNumbered: the chunk has more than one material, so faces are cut where it
/// changes, and planes beyond the first exist.
template <class Lanes, bool kNumbered>
class Sweep {
  using Row = typename Lanes::Row;
  using V = typename Lanes::V;
  using Rows = LayerRows<Row>;
  static constexpr unsigned kLanes = Lanes::kLanes;

 public:
  Sweep(const SweepInput& input, const Borders<Row>& borders, SweepState<Row>& state)
      : in_(input),
        borders_(borders),
        st_(state),
        e_(input.extent),
        line_of_(input.extent.f),
        number_bits_(kNumbered ? input.codes->number_bits() : 0),
        mixed_(kNumbered && input.codes->has_transparent()),
        planes_(1 + number_bits_ + (mixed_ ? 1 : 0)),
        valid_(bits_below<Row>(input.extent.f)),
        last_(Row{1} << (input.extent.f - 1)) {}

  void run() {
    start();
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      const std::uint32_t begin = s * e_.layer();
      if (runs()[run_].end == begin) ++run_;
      if (s != 0 && repeats(s)) continue;
      build(s);
      if (s == 0) hide_slow(Side::slow_neg, there_, here_);
      slow_faces<Side::slow_neg>(s, here_, there_);
      if (s != 0) slow_faces<Side::slow_pos>(s - 1, there_, here_);
      level_faces<Side::mid_neg>(s);
      level_faces<Side::mid_pos>(s);
      upright_faces<Side::fast_neg>(s);
      upright_faces<Side::fast_pos>(s);
      std::swap(here_, there_);
    }
    finish();
  }

 private:
  const CodedRun* runs() const { return in_.runs.data(); }
  static constexpr std::size_t at(Side side) { return static_cast<std::size_t>(side); }
  Row* plane(unsigned ring, unsigned k) { return st_.plane[ring][k].data(); }

  /// Calls step(first row) for every step of whole vectors over the rows of a layer.
  template <class F>
  HWY_INLINE void for_rows(F&& step) const {
    for (std::uint32_t m = 0; m < e_.m; m += kLanes) step(m);
  }

  void start() {
    const auto clear = [this](Rows& rows) { std::fill_n(rows.data(), e_.m + Rows::kBehind, Row{0}); };
    clear(st_.solid[there_]);
    for (unsigned side = at(Side::mid_neg); side <= at(Side::fast_pos); ++side) {
      FaceRows<Row>& before = st_.faces[side][there_];
      clear(before.face);
      clear(before.start);
      clear(before.end);
      clear(st_.faces[side][here_].face);
    }
    for (unsigned k = 0; k < planes_; ++k) clear(st_.plane[there_][k]);
  }

  /// Whether the layer is of one material and so was the one before, with equal borders: nothing begins or
  /// ends.
  bool repeats(std::uint32_t s) const {
    const std::uint32_t begin = s * e_.layer();
    const CodedRun& run = runs()[run_];
    const std::uint32_t run_begin = run_ == 0 ? 0 : runs()[run_ - 1].end;
    if (run_begin + e_.layer() > begin || run.end < begin + e_.layer()) return false;
    if (run.code == 0) return true;
    for (unsigned side = at(Side::mid_neg); side <= at(Side::fast_pos); ++side) {
      if (borders_.plane[side][0][s] != borders_.plane[side][0][s - 1]) return false;
      if (borders_.clear[side] && (run.code & kTransparentBit) != 0) return false;
    }
    return true;
  }

  /// Makes the planes of layer s from the runs that lie in it.
  void build(std::uint32_t s) {
    const std::uint32_t begin = s * e_.layer();
    const std::uint32_t end = begin + e_.layer();
    const Code first = runs()[run_].code;
    for (unsigned k = 0; k < planes_; ++k) std::fill_n(plane(here_, k), e_.m, Row{0});
    if (runs()[run_].end < end) {
      switch (planes_) {
        case 1:
          mark_changes<1>(begin, end);
          break;
        case 2:
          mark_changes<2>(begin, end);
          break;
        case 3:
          mark_changes<3>(begin, end);
          break;
        case 4:
          mark_changes<4>(begin, end);
          break;
        case 5:
          mark_changes<5>(begin, end);
          break;
        case 6:
          mark_changes<6>(begin, end);
          break;
        case 7:
          mark_changes<7>(begin, end);
          break;
        default:
          mark_changes<kPlanesMax>(begin, end);
          break;
      }
    }
    for (unsigned k = 0; k < planes_; ++k) fill_plane(plane(here_, k), (first >> code_bit(k) & 1) != 0);
    join_planes();
    hide_middle(s);
    if constexpr (kNumbered) find_cuts(s);
  }

  /// The bit of a code that plane k holds.
  unsigned code_bit(unsigned k) const {
    return mixed_ && k + 1 == planes_ ? static_cast<unsigned>(std::countr_zero(kTransparentBit)) : k;
  }

  /// Sets a bit in each plane where the material's bit changes; the first change of the layer is not one.
  template <unsigned kPlanes>
  void mark_changes(std::uint32_t begin, std::uint32_t end) {
    const CodedRun* run = runs() + run_;
    constexpr std::size_t kStride = sizeof(Rows) / sizeof(Row);
    Row* const rows = plane(here_, 0);
    const unsigned planes = kPlanes == kPlanesMax ? planes_ : kPlanes;
    const unsigned top_bit = code_bit(planes - 1);
    for (; run->end < end; ++run) {
      const std::uint32_t at = run->end - begin;
      const std::uint32_t line = line_of_(at);
      const unsigned bit = at - line * e_.f;
      const Code change = run[0].code ^ run[1].code;
      Row* row = rows + line;
      for (unsigned k = 0; k + 1 < planes; ++k, row += kStride) *row ^= Row{change >> k & 1} << bit;
      *row ^= Row{change >> top_bit & 1} << bit;
    }
    run_ = static_cast<std::size_t>(run - runs());
  }

  /// Turns marks of change into the bits themselves, from the first voxel's on.
  void fill_plane(Row* rows, bool first) {
    std::array<std::uint64_t, 2> tops{};
    for_rows([&](std::uint32_t m) {
      V v = Lanes::load(rows + m);
      v = Lanes::differing(v, Lanes::template up<1>(v));
      v = Lanes::differing(v, Lanes::template up<2>(v));
      v = Lanes::differing(v, Lanes::template up<4>(v));
      v = Lanes::differing(v, Lanes::template up<8>(v));
      v = Lanes::differing(v, Lanes::template up<16>(v));
      v = Lanes::differing(v, Lanes::template up<32>(v));
      if constexpr (kRowBits<Row> == 128) v = Lanes::differing(v, Lanes::template up<64>(v));
      Lanes::store(v, rows + m);
      tops[m / 64] |= Lanes::tops(v) << (m % 64);
    });
    // Bit m: whether row m starts with ones.
    std::array<std::uint64_t, 2> starts{};
    std::uint64_t carry = first ? ~std::uint64_t{0} : 0;
    for (std::size_t w = 0; w * 64 < e_.m; ++w) {
      const std::uint64_t through = prefix_xor(tops[w]);
      starts[w] = through << 1 ^ carry;
      carry ^= std::uint64_t{0} - (through >> 63);
    }
    const V valid = Lanes::all(valid_);
    for_rows([&](std::uint32_t m) {
      const V flip = Lanes::where(starts[m / 64] >> (m % 64), ~Row{0});
      Lanes::store(Lanes::both(Lanes::differing(Lanes::load(rows + m), flip), valid), rows + m);
    });
  }

  void join_planes() {
    const Row* const opaque = plane(here_, 0);
    Row* const solid = st_.solid[here_].data();
    Row* const hiding = st_.hiding[here_].data();
    if (mixed_) {
      const Row* const clear = plane(here_, planes_ - 1);
      for_rows([&](std::uint32_t m) {
        const V v = Lanes::load(opaque + m);
        Lanes::store(v, hiding + m);
        Lanes::store(Lanes::either(v, Lanes::load(clear + m)), solid + m);
      });
    } else {
      for_rows([&](std::uint32_t m) {
        const V v = Lanes::load(opaque + m);
        Lanes::store(v, hiding + m);
        Lanes::store(v, solid + m);
      });
    }
    std::fill_n(solid + e_.m, Rows::kBehind, Row{0});
  }

  /// Bits where our transparent voxels meet their own kind beyond a border. `ours(k)`: our bits of plane k.
  template <class Ours>
  Row same_beyond(Side side, std::uint32_t row, Ours&& ours) const {
    const auto& theirs = borders_.plane[at(side)];
    Row same = theirs[planes_ - 1][row];
    if (same == 0) return 0;
    same &= ours(planes_ - 1);
    for (unsigned k = 1; k + 1 < planes_ && same != 0; ++k) same &= ~(theirs[k][row] ^ ours(k));
    return same;
  }

  /// Puts what lies beyond a slow side into the hiding rows of `ring`, as if it were a layer; `ours` is the
  /// ring of our layer there.
  void hide_slow(Side side, unsigned ring, [[maybe_unused]] unsigned ours) {
    Row* const hiding = st_.hiding[ring].data();
    std::copy_n(borders_.plane[at(side)][0].data(), e_.m, hiding);
    if constexpr (kNumbered) {
      if (!borders_.clear[at(side)]) return;
      for (std::uint32_t m = 0; m < e_.m; ++m) {
        hiding[m] |= same_beyond(side, m, [&](unsigned k) { return plane(ours, k)[m]; });
      }
    }
  }

  void hide_middle(std::uint32_t s) {
    for (const Side side : {Side::mid_neg, Side::mid_pos}) {
      const bool negative = side == Side::mid_neg;
      const std::uint32_t own = negative ? 0 : e_.m - 1;
      Row hide = borders_.plane[at(side)][0][s];
      if constexpr (kNumbered) {
        if (borders_.clear[at(side)]) {
          hide |= same_beyond(side, s, [&](unsigned k) { return plane(here_, k)[own]; });
        }
      }
      *(st_.hiding[here_].data() + (negative ? -1 : static_cast<std::ptrdiff_t>(e_.m))) = hide;
    }
  }

  /// What hides the faces of a fast side in layer s: bit m is line m.
  Row hide_fast(Side side, std::uint32_t s) {
    Row hide = borders_.plane[at(side)][0][s];
    if constexpr (kNumbered) {
      if (borders_.clear[at(side)]) {
        const V bit = Lanes::all(side == Side::fast_neg ? Row{1} : last_);
        hide |= same_beyond(side, s, [&](unsigned k) {
          Row column = 0;
          for_rows([&](std::uint32_t m) {
            column |= Row{Lanes::any(Lanes::both(Lanes::load(plane(here_, k) + m), bit))} << m;
          });
          return column;
        });
      }
    }
    return hide;
  }

  /// Where the material differs from the voxel before, along each axis; at the borders always.
  void find_cuts(std::uint32_t s) {
    Row* const fast = st_.cut_fast[here_].data();
    Row* const mid = st_.cut_mid[here_].data();
    Row* const slow = st_.cut_slow.data();
    constexpr std::size_t kStride = sizeof(Rows) / sizeof(Row);
    const Row* const here = plane(here_, 0);
    const Row* const there = plane(there_, 0);
    for_rows([&](std::uint32_t m) {
      V f = Lanes::all(Row{1});
      V mm = Lanes::all(Row{0});
      V ss = mm;
      for (unsigned k = 0; k < planes_; ++k) {
        const V v = Lanes::load(here + k * kStride + m);
        f = Lanes::either(f, Lanes::differing(v, Lanes::template up<1>(v)));
        mm = Lanes::either(mm, Lanes::differing(v, Lanes::load(here + k * kStride + m - 1)));
        ss = Lanes::either(ss, Lanes::differing(v, Lanes::load(there + k * kStride + m)));
      }
      Lanes::store(f, fast + m);
      Lanes::store(mm, mid + m);
      Lanes::store(ss, slow + m);
    });
    mid[0] = mid[e_.m] = ~Row{0};
    if (s == 0) std::fill_n(slow, e_.m, ~Row{0});
  }

  /// Starts and ends of strips along the bits of a row, cut where `cut` says.
  static HWY_INLINE V starts_of(V face, V cut) {
    const V before = Lanes::template up<1>(face);
    return Lanes::without(face, kNumbered ? Lanes::without(before, cut) : before);
  }
  static HWY_INLINE V ends_of(V face, V cut) {
    const V behind = Lanes::down(face);
    return Lanes::without(face, kNumbered ? Lanes::without(behind, Lanes::down(cut)) : behind);
  }

  /// Bits of strips in `now` or `before` where the two rows do not agree.
  struct Change {
    V closing, opening;  // the last bits of the strips that end and begin between the two rows
  };
  static HWY_INLINE V changed(const FaceRows<Row>& now, std::ptrdiff_t m, const FaceRows<Row>& before,
                              std::ptrdiff_t n, V cut) {
    const V f = Lanes::load(now.face.data() + m);
    const V g = Lanes::load(before.face.data() + n);
    V x = Lanes::either(
        Lanes::differing(f, g),
        Lanes::either(
            Lanes::differing(Lanes::load(now.start.data() + m), Lanes::load(before.start.data() + n)),
            Lanes::differing(Lanes::load(now.end.data() + m), Lanes::load(before.end.data() + n))));
    if constexpr (kNumbered) x = Lanes::either(x, Lanes::both(Lanes::both(f, g), cut));
    return x;
  }
  /// Ends of the strips with a changed bit. A carry runs from the lowest changed bit of a strip to its end:
  /// all other bits of a strip are ones, and the end itself is left out.
  static HWY_INLINE V ends_with(V face, V end, V x) {
    x = Lanes::both(x, face);
    const V inner = Lanes::without(face, end);
    return Lanes::both(end, Lanes::either(x, Lanes::sum(inner, Lanes::both(x, inner))));
  }
  static HWY_INLINE Change change_of(const FaceRows<Row>& now, std::ptrdiff_t m, const FaceRows<Row>& before,
                                     std::ptrdiff_t n, V cut) {
    const V x = changed(now, m, before, n, cut);
    return {ends_with(Lanes::load(before.face.data() + n), Lanes::load(before.end.data() + n), x),
            ends_with(Lanes::load(now.face.data() + m), Lanes::load(now.end.data() + m), x)};
  }

  /// Rows in which something happens.
  using RowSet = std::array<std::uint64_t, 2>;
  template <class F>
  HWY_INLINE void for_set(const RowSet& set, F&& visit) const {
    for (std::uint32_t w = 0; w * 64 < e_.m; ++w) {
      for (std::uint64_t bits = set[w]; bits != 0; bits &= bits - 1) visit(w * 64 + lowest_bit(bits));
    }
  }
  void keep_rows(RowSet& set) const {
    set[e_.m / 64 % 2] &= e_.m % 64 == 0 ? ~std::uint64_t{0} : bits_below<std::uint64_t>(e_.m % 64);
  }

  /// Faces across the slowest axis of layer `layer`, in ring `own`, towards ring `other`. A row is a line.
  template <Side kSide>
  void slow_faces(std::uint32_t layer, unsigned own, unsigned other) {
    FaceRows<Row>& faces = st_.faces[at(kSide)][0];
    const Row* const solid = st_.solid[own].data();
    const Row* const hiding = st_.hiding[other].data();
    const Row* const cut_fast = st_.cut_fast[own].data();
    const Row* const cut_slow = st_.cut_slow.data();
    std::uint64_t any = 0;
    for_rows([&](std::uint32_t m) {
      V f = Lanes::without(Lanes::load(solid + m), Lanes::load(hiding + m));
      V cut = f;
      if constexpr (kNumbered) {
        f = Lanes::both(f, Lanes::load(cut_slow + m));
        cut = Lanes::load(cut_fast + m);
      }
      Lanes::store(f, faces.face.data() + m);
      Lanes::store(starts_of(f, cut), faces.start.data() + m);
      Lanes::store(ends_of(f, cut), faces.end.data() + m);
      any |= Lanes::any(f);
    });
    if (any == 0) return;
    RowSet rows{};
    const Row* const cut_mid = st_.cut_mid[own].data();
    for_rows([&](std::uint32_t m) {
      const Change c = change_of(faces, m, faces, static_cast<std::ptrdiff_t>(m) - 1,
                                 kNumbered ? Lanes::load(cut_mid + m) : Lanes::all(0));
      Lanes::store(c.closing, st_.closing.data() + m);
      Lanes::store(c.opening, st_.opening.data() + m);
      rows[m / 64] |= Lanes::any(Lanes::either(c.closing, c.opening)) << (m % 64);
    });
    keep_rows(rows);
    std::uint8_t* const first = st_.row_first[at(kSide)].data();
    const Row* const start = faces.start.data();
    for_set(rows, [&](std::uint32_t m) {
      close_strips<kSide>(st_.closing.data()[m], start[static_cast<std::ptrdiff_t>(m) - 1], first, layer, m,
                          own, m - 1);
      Lanes::mark(first, st_.opening.data()[m], static_cast<std::uint8_t>(m));
    });
    close_strips<kSide>(faces.end.data()[e_.m - 1], start[e_.m - 1], first, layer, e_.m, own, e_.m - 1);
  }

  /// Emits the strips that end at the bits of `closing`: they began at bits of `start`, in the rows that
  /// `first` says, and ended before row `row`. Their material is that of row `line` in ring `ring`.
  template <Side kSide>
  HWY_INLINE void close_strips(Row closing, Row start, const std::uint8_t* first, std::uint32_t layer,
                               std::uint32_t row, unsigned ring, std::uint32_t line) {
    for (; closing != 0; closing &= closing - 1) {
      const unsigned end = lowest_bit(closing);
      const unsigned begin = highest_bit(start & (closing ^ (closing - 1)));
      put<kSide>({layer, begin, end - begin + 1, first[end], row - first[end]}, ring, line, begin);
    }
  }

  /// Faces across the middle axis in layer s. A row is the line of a layer, its next one that of the next.
  template <Side kSide>
  void level_faces(std::uint32_t s) {
    constexpr std::ptrdiff_t kBeyond = kSide == Side::mid_neg ? -1 : 1;
    FaceRows<Row>& now = st_.faces[at(kSide)][here_];
    const FaceRows<Row>& before = st_.faces[at(kSide)][there_];
    const Row* const solid = st_.solid[here_].data();
    const Row* const hiding = st_.hiding[here_].data() + kBeyond;
    const Row* const cut_fast = st_.cut_fast[here_].data();
    const Row* const cut_mid = st_.cut_mid[here_].data() + (kSide == Side::mid_neg ? 0 : 1);
    const Row* const cut_slow = st_.cut_slow.data();
    RowSet rows{};
    for_rows([&](std::uint32_t m) {
      V f = Lanes::without(Lanes::load(solid + m), Lanes::load(hiding + m));
      V cut = f;
      if constexpr (kNumbered) {
        f = Lanes::both(f, Lanes::load(cut_mid + m));
        cut = Lanes::load(cut_fast + m);
      }
      Lanes::store(f, now.face.data() + m);
      Lanes::store(starts_of(f, cut), now.start.data() + m);
      Lanes::store(ends_of(f, cut), now.end.data() + m);
      const Change c = change_of(now, m, before, m, kNumbered ? Lanes::load(cut_slow + m) : Lanes::all(0));
      Lanes::store(c.closing, st_.closing.data() + m);
      Lanes::store(c.opening, st_.opening.data() + m);
      rows[m / 64] |= Lanes::any(Lanes::either(c.closing, c.opening)) << (m % 64);
    });
    keep_rows(rows);
    for_set(rows, [&](std::uint32_t m) {
      std::uint8_t* const first = st_.row_first[at(kSide)].data() + std::size_t{m} * kRowBits<Row>;
      close_strips<kSide>(st_.closing.data()[m], before.start.data()[m], first, m, s, there_, m);
      Lanes::mark(first, st_.opening.data()[m], static_cast<std::uint8_t>(s));
    });
  }

  /// Faces across the fastest axis in layer s: every bit is a layer of its own, and strips run from line to
  /// line.
  template <Side kSide>
  void upright_faces(std::uint32_t s) {
    FaceRows<Row>& now = st_.faces[at(kSide)][here_];
    const FaceRows<Row>& before = st_.faces[at(kSide)][there_];
    const Row* const solid = st_.solid[here_].data();
    const Row* const hiding = st_.hiding[here_].data();
    const Row* const cut_fast = st_.cut_fast[here_].data();
    const Row hide = hide_fast(kSide, s);
    for_rows([&](std::uint32_t m) {
      const auto lanes = static_cast<std::uint64_t>(hide >> m);
      const V h = Lanes::load(hiding + m);
      V cut = h;
      if constexpr (kNumbered) cut = Lanes::load(cut_fast + m);
      V beyond;
      if constexpr (kSide == Side::fast_neg) {
        beyond = Lanes::either(Lanes::template up<1>(h), Lanes::where(lanes, Row{1}));
      } else {
        beyond = Lanes::either(Lanes::down(h), Lanes::where(lanes, last_));
        if constexpr (kNumbered) cut = Lanes::either(Lanes::down(cut), Lanes::all(last_));
      }
      V f = Lanes::without(Lanes::load(solid + m), beyond);
      if constexpr (kNumbered) f = Lanes::both(f, cut);
      Lanes::store(f, now.face.data() + m);
    });
    RowSet rows{};
    const Row* const face = now.face.data();
    const Row* const cut_mid = st_.cut_mid[here_].data();
    for_rows([&](std::uint32_t m) {
      const V f = Lanes::load(face + m);
      V low = Lanes::load(face + m - 1);
      V high = Lanes::load(face + m + 1);
      if constexpr (kNumbered) {
        low = Lanes::without(low, Lanes::load(cut_mid + m));
        high = Lanes::without(high, Lanes::load(cut_mid + m + 1));
      }
      Lanes::store(Lanes::without(f, low), now.start.data() + m);
      Lanes::store(Lanes::without(f, high), now.end.data() + m);
      const V x =
          changed(now, m, before, m, kNumbered ? Lanes::load(st_.cut_slow.data() + m) : Lanes::all(0));
      Lanes::store(x, st_.changed.data() + m);
      rows[m / 64] |= Lanes::any(x) << (m % 64);
    });
    keep_rows(rows);
    std::uint32_t done = 0;
    for_set(rows, [&](std::uint32_t m) {
      if (m >= done) done = follow_strips<kSide>(now, before, m, s);
    });
  }

  /// Follows the strips with changed bits from line m on, closes and opens them where they end, and returns
  /// the line behind the last of them.
  template <Side kSide>
  std::uint32_t follow_strips(const FaceRows<Row>& now, const FaceRows<Row>& before, std::uint32_t m,
                              std::uint32_t s) {
    Row closing = 0;
    Row opening = 0;
    const Row* const start_before = before.start.data();
    do {
      const Row x = st_.changed.data()[m];
      closing = ((closing & ~start_before[m]) | x) & before.face.data()[m];
      opening = ((opening & ~now.start.data()[m]) | x) & now.face.data()[m];
      const Row ends = closing & before.end.data()[m];
      const Row begins = opening & now.end.data()[m];
      std::uint8_t* const first = st_.row_first[at(kSide)].data() + std::size_t{m} * kRowBits<Row>;
      for (Row bits = ends; bits != 0; bits &= bits - 1) {
        const unsigned bit = lowest_bit(bits);
        const Row here = bits & (Row{0} - bits);
        std::uint32_t begin = m;
        while ((start_before[begin] & here) == 0) --begin;
        put<kSide>({bit, begin, m - begin + 1, first[bit], s - first[bit]}, there_, m, bit);
      }
      if (begins != 0) Lanes::mark(first, begins, static_cast<std::uint8_t>(s));
      closing &= ~ends;
      opening &= ~begins;
      ++m;
    } while ((closing | opening) != 0 && m < e_.m);
    return m;
  }

  /// Closes what reaches the last layer.
  void finish() {
    hide_slow(Side::slow_pos, here_, there_);
    if constexpr (kNumbered) std::fill_n(st_.cut_slow.data(), e_.m, ~Row{0});
    slow_faces<Side::slow_pos>(e_.s - 1, there_, here_);
    finish_level<Side::mid_neg>();
    finish_level<Side::mid_pos>();
    finish_upright<Side::fast_neg>();
    finish_upright<Side::fast_pos>();
  }
  template <Side kSide>
  void finish_level() {
    const FaceRows<Row>& last = st_.faces[at(kSide)][there_];
    for (std::uint32_t m = 0; m < e_.m; ++m) {
      const std::uint8_t* const first = st_.row_first[at(kSide)].data() + std::size_t{m} * kRowBits<Row>;
      close_strips<kSide>(last.end.data()[m], last.start.data()[m], first, m, e_.s, there_, m);
    }
  }
  template <Side kSide>
  void finish_upright() {
    const FaceRows<Row>& last = st_.faces[at(kSide)][there_];
    FaceRows<Row>& none = st_.faces[at(kSide)][here_];
    std::fill_n(none.face.data(), e_.m, Row{0});
    std::fill_n(none.start.data(), e_.m, Row{0});
    std::fill_n(none.end.data(), e_.m, Row{0});
    std::copy_n(last.face.data(), e_.m, st_.changed.data());
    for (std::uint32_t m = 0; m < e_.m;) {
      m = last.face.data()[m] == 0 ? m + 1 : follow_strips<kSide>(none, last, m, e_.s);
    }
  }

  /// Packs a rectangle whose material is that of bit `bit` of row `line` in `ring`.
  template <Side kSide>
  HWY_INLINE void put(const Rectangle& r, unsigned ring, std::uint32_t line, unsigned bit) {
    QuadBuckets* bucket = in_.opaque;
    bool transparent = false;
    std::size_t number = 0;
    if constexpr (kNumbered) {
      for (unsigned k = 0; k < number_bits_; ++k) {
        number |= static_cast<std::size_t>(plane(ring, 1 + k)[line] >> bit & 1) << k;
      }
      transparent = mixed_ && (plane(ring, planes_ - 1)[line] >> bit & 1) != 0;
    } else {
      transparent = in_.codes->has_transparent();
    }
    if (transparent) bucket = in_.transparent;
    bucket->put(in_.direction[at(kSide)], r.layer,
                in_.shape[at(kSide)].quad(r, in_.codes->material(transparent, number)));
  }

  const SweepInput& in_;
  const Borders<Row>& borders_;
  SweepState<Row>& st_;
  const OrderedExtent e_;
  const Divider line_of_;
  const unsigned number_bits_;
  const bool mixed_;
  const unsigned planes_;
  const Row valid_, last_;
  std::size_t run_ = 0;
  unsigned here_ = 0, there_ = 1;  // rings of the layer at hand and the one before it
};

template <class Lanes>
void sweep(const SweepInput& input, const Borders<typename Lanes::Row>& borders,
           SweepState<typename Lanes::Row>& state) {
  if (input.codes->solid_count() > 1) {
    Sweep<Lanes, true>(input, borders, state).run();
  } else {
    Sweep<Lanes, false>(input, borders, state).run();
  }
}

void sweep_64(const SweepInput& input, const Borders<Row64>& borders, SweepState<Row64>& state) {
  sweep<VectorRows>(input, borders, state);
}
void sweep_128(const SweepInput& input, const Borders<Row128>& borders, SweepState<Row128>& state) {
  sweep<OneRow<Row128>>(input, borders, state);
}
void sweep_plain(const SweepInput& input, const Borders<Row64>& borders, SweepState<Row64>& state) {
  sweep<OneRow<Row64>>(input, borders, state);
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace runstone::rdm {

HWY_EXPORT(sweep_64);
HWY_EXPORT(sweep_128);
HWY_EXPORT(sweep_plain);

void sweep_layers(const SweepInput& input, const Borders<Row64>& borders, SweepState<Row64>& state) {
  HWY_DYNAMIC_DISPATCH(sweep_64)(input, borders, state);
}
void sweep_layers(const SweepInput& input, const Borders<Row128>& borders, SweepState<Row128>& state) {
  HWY_DYNAMIC_DISPATCH(sweep_128)(input, borders, state);
}
void sweep_layers_plain(const SweepInput& input, const Borders<Row64>& borders, SweepState<Row64>& state) {
  HWY_DYNAMIC_DISPATCH(sweep_plain)(input, borders, state);
}

}  // namespace runstone::rdm
#endif
