#include "common/mesh/rdm/layer_sweep.hpp"

#include <algorithm>
#include <bit>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/row_strips.hpp"

// The rest of this file is compiled once per instruction set; Highway picks one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/mesh/rdm/layer_sweep.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "common/mesh/rdm/code_lanes-inl.hpp"
#include "common/mesh/rdm/row_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

/// One call of sweep_layers(). C: the form of its codes. kNumbered: the chunk has more than one material, so
/// faces are cut where it changes.
template <class Lanes, class CodeLanes, class C, bool kNumbered>
class Sweep {
  using Row = typename Lanes::Row;
  using V = typename Lanes::V;
  using Rows = LayerRows<Row>;
  using Line = typename CodeLanes::template Line<Row, C>;
  static constexpr unsigned kLanes = Lanes::kLanes;
  static_assert(CodeLanes::template kBehind<C> <= LayerCodes<Row, C>::kRoom);

 public:
  Sweep(const SweepInput& input, const Borders<Row>& borders, SweepState<Row>& state)
      : in_(input),
        borders_(borders),
        st_(state),
        e_(input.extent),
        codes_(codes_of(state)),
        mixed_(kNumbered && input.codes->has_transparent()),
        valid_(bits_below<Row>(input.extent.f)),
        last_(Row{1} << (input.extent.f - 1)) {}

  void run() {
    start();
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      const std::uint32_t begin = s * e_.layer();
      if (runs()[run_].end == begin) ++run_;
      if (s != 0 && repeats(s)) {
        if (in_.own_sides) repeat_own_sides(s);
        continue;
      }
      build(s);
      if (in_.own_sides) find_own_sides(s);
      if (s == 0) hide_slow(Side::slow_neg, there_, here_);
      find_faces(s);
      std::swap(here_, there_);
    }
    finish();
  }

 private:
  const CodedRun* runs() const { return in_.runs.data(); }
  static constexpr std::size_t at(Side side) { return static_cast<std::size_t>(side); }
  static auto& codes_of(SweepState<Row>& state) {
    if constexpr (sizeof(C) == 1) {
      return state.byte_codes;
    } else {
      if (!state.whole_codes)
        state.whole_codes = std::make_unique<typename SweepState<Row>::template Codes<C>>();
      return *state.whole_codes;
    }
  }
  C* codes(unsigned ring) { return codes_[ring].data(); }

  /// A set of rows in which something happens: a bit each.
  using RowSet = Row;
  static HWY_INLINE void add_rows(RowSet& set, std::uint64_t lanes, std::uint32_t m) {
    set |= Row{lanes} << m;
  }

  /// Calls step(first row) for every step of whole vectors over the rows of a layer.
  template <class F>
  HWY_INLINE void for_rows(F&& step) const {
    const std::uint32_t count = e_.m;
    for (std::uint32_t m = 0; m < count; m += kLanes) step(m);
  }

  void start() {
    const auto clear = [this](Rows& rows) { std::fill_n(rows.data(), e_.m + Rows::kBehind, Row{0}); };
    clear(st_.solid[there_]);
    for (unsigned side = at(Side::mid_neg); side <= at(Side::fast_pos); ++side) {
      clear(st_.face[side][there_]);
      clear(st_.face[side][here_]);
    }
    if constexpr (kNumbered) {
      clear(st_.cut_fast[there_]);
      clear(st_.cut_mid[there_]);
    }
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
      if (borders_.hiding[side][s] != borders_.hiding[side][s - 1]) return false;
      if (borders_.meets[side] && (run.code & kTransparentBit) != 0) return false;
    }
    return true;
  }

  /// Makes the codes and the rows of layer s from the runs that lie in it.
  void build(std::uint32_t s) {
    decode(s);
    const C* line = codes(here_);
    const C* line_there = codes(there_);
    Row* const solid = st_.solid[here_].data();
    Row* const hiding = st_.hiding[here_].data();
    Row* const transparent = st_.transparent.data();
    Row* const fast = st_.cut_fast[here_].data();
    Row* const mid = st_.cut_mid[here_].data();
    Row* const slow = st_.cut_slow.data();
    const std::uint32_t count = e_.m;
    Line above = Line::at(line - e_.f);
    for (std::uint32_t m = 0; m < count; ++m, line += e_.f, line_there += e_.f) {
      const Line own = Line::at(line);
      const Row faced = own.solid() & valid_;
      solid[m] = faced;
      hiding[m] = faced;
      if constexpr (kNumbered) {
        if (mixed_) {
          transparent[m] = own.transparent() & valid_;
          hiding[m] = faced & ~transparent[m];
        }
        fast[m] = differing(own, Line::at(line - 1)) | 1;
        mid[m] = differing(own, above);
        slow[m] = differing(own, Line::at(line_there));
        above = own;
      }
    }
    std::fill_n(solid + count, Rows::kBehind, Row{0});
    if constexpr (kNumbered) {
      mid[0] = mid[count] = ~Row{0};
      if (s == 0) std::fill_n(slow, count, ~Row{0});
    }
    hide_middle(s);
  }

  /// What layer s adds to the chunk's own sides.
  void find_own_sides(std::uint32_t s) {
    const Row* const opaque = st_.hiding[here_].data();
    auto& own = st_.own_sides;
    own[at(Side::mid_neg)][s] = opaque[0];
    own[at(Side::mid_pos)][s] = opaque[e_.m - 1];
    own[at(Side::fast_neg)][s] = column_of(opaque, Row{1});
    own[at(Side::fast_pos)][s] = column_of(opaque, last_);
    if (s == 0) std::copy_n(opaque, e_.m, own[at(Side::slow_neg)].data());
    if (s + 1 == e_.s) std::copy_n(opaque, e_.m, own[at(Side::slow_pos)].data());
    if (s == 0) st_.own_transparent.fill(false);
    if (!mixed_) return;
    const Row* const clear = st_.transparent.data();
    auto& found = st_.own_transparent;
    found[at(Side::mid_neg)] |= clear[0] != 0;
    found[at(Side::mid_pos)] |= clear[e_.m - 1] != 0;
    found[at(Side::fast_neg)] |= column_of(clear, Row{1}) != 0;
    found[at(Side::fast_pos)] |= column_of(clear, last_) != 0;
    const bool any = std::any_of(clear, clear + e_.m, [](Row row) { return row != 0; });
    if (s == 0) found[at(Side::slow_neg)] = any;
    if (s + 1 == e_.s) found[at(Side::slow_pos)] = any;
  }
  /// Bit m: whether row m has the bit of `bit`.
  Row column_of(const Row* rows, Row bit) const {
    const V wanted = Lanes::all(bit);
    Row column = 0;
    for_rows([&](std::uint32_t m) {
      add_rows(column, Lanes::any(Lanes::both(Lanes::load(rows + m), wanted)), m);
    });
    return column & bits_below<Row>(e_.m);
  }
  /// The same for a layer that repeats the one before it.
  void repeat_own_sides(std::uint32_t s) {
    auto& own = st_.own_sides;
    for (unsigned side = at(Side::mid_neg); side <= at(Side::fast_pos); ++side)
      own[side][s] = own[side][s - 1];
    if (s + 1 != e_.s) return;
    std::copy_n(st_.hiding[there_].data(), e_.m, own[at(Side::slow_pos)].data());
    // One material: its first line has it, if any has.
    st_.own_transparent[at(Side::slow_pos)] = mixed_ && st_.transparent.data()[0] != 0;
  }

  /// Writes the codes of layer s, and some behind them.
  void decode(std::uint32_t s) {
    const std::uint32_t begin = s * e_.layer();
    const std::uint32_t end = begin + e_.layer();
    C* const first = codes(here_);
    C* to = first;
    const CodedRun* run = runs() + run_;
    for (; run->end < end; ++run) {
      C* const stop = first + (run->end - begin);
      CodeLanes::fill(to, stop, code_as<C>(run->code));
      to = stop;
    }
    CodeLanes::fill(to, first + e_.layer(), code_as<C>(run->code));
    run_ = static_cast<std::size_t>(run - runs());
  }

  /// Where transparent voxels of ours meet their own kind beyond a border: `ours` are the transparent ones of
  /// a row, and `code_at(bit)` their codes.
  template <class CodeAt>
  Row same_beyond(Side side, std::uint32_t row, std::uint32_t bits, Row ours, CodeAt&& code_at) const {
    Row same = ours & borders_.transparent[at(side)][row];
    if (const auto& theirs = borders_.codes[at(side)]; !theirs.empty()) {
      for (Row left = same; left != 0; left &= left - 1) {
        const unsigned bit = lowest_bit(left);
        if (whole_code(code_at(bit)) != theirs[std::size_t{row} * bits + bit]) same ^= Row{1} << bit;
      }
    }
    return same;
  }
  /// The same for a line of ours.
  Row same_beyond_line(Side side, std::uint32_t row, const C* line) const {
    const Row ours = Line::at(line).transparent() & valid_;
    return same_beyond(side, row, e_.f, ours, [line](unsigned bit) { return line[bit]; });
  }

  /// Puts what lies beyond a slow side into the hiding rows of `ring`, as if it were a layer; `ours` is the
  /// ring of our layer there.
  void hide_slow(Side side, unsigned ring, [[maybe_unused]] unsigned ours) {
    Row* const hiding = st_.hiding[ring].data();
    std::copy_n(borders_.hiding[at(side)].data(), e_.m, hiding);
    if constexpr (kNumbered) {
      if (!borders_.meets[at(side)]) return;
      const C* line = codes(ours);
      for (std::uint32_t m = 0; m < e_.m; ++m, line += e_.f) hiding[m] |= same_beyond_line(side, m, line);
    }
  }

  void hide_middle(std::uint32_t s) {
    for (const Side side : {Side::mid_neg, Side::mid_pos}) {
      const bool negative = side == Side::mid_neg;
      Row hide = borders_.hiding[at(side)][s];
      if constexpr (kNumbered) {
        if (borders_.meets[at(side)]) {
          hide |= same_beyond_line(side, s, codes(here_) + (negative ? 0 : (e_.m - 1) * e_.f));
        }
      }
      *(st_.hiding[here_].data() + (negative ? -1 : static_cast<std::ptrdiff_t>(e_.m))) = hide;
    }
  }

  /// What hides the faces of a fast side in layer s: bit m is line m.
  Row hide_fast(Side side, std::uint32_t s) {
    Row hide = borders_.hiding[at(side)][s];
    if constexpr (kNumbered) {
      if (borders_.meets[at(side)]) {
        const Row ours = column_of(st_.transparent.data(), side == Side::fast_neg ? Row{1} : last_);
        const C* const column = codes(here_) + (side == Side::fast_neg ? 0 : e_.f - 1);
        hide |= same_beyond(side, s, e_.m, ours, [column, f = e_.f](unsigned m) { return column[m * f]; });
      }
    }
    return hide;
  }

  /// Finds the faces of layer s across the middle and the fastest axis, and those between it and the layer
  /// before it; then follows the strips in the rows that differ from the row before.
  void find_faces(std::uint32_t s) {
    const std::uint32_t count = e_.m;
    const Row* const solid = st_.solid[here_].data();
    const Row* const hiding = st_.hiding[here_].data();
    const Row* const solid_there = st_.solid[there_].data();
    const Row* const hiding_there = st_.hiding[there_].data();
    const Row* const cut_fast = st_.cut_fast[here_].data();
    const Row* const cut_fast_there = st_.cut_fast[there_].data();
    const Row* const cut_mid = st_.cut_mid[here_].data();
    const Row* const cut_mid_there = st_.cut_mid[there_].data();
    const Row* const cut_slow = st_.cut_slow.data();
    const auto face = [this](Side side, unsigned ring) { return st_.face[at(side)][ring].data(); };
    Row* const slow_neg = face(Side::slow_neg, 0);
    Row* const slow_pos = face(Side::slow_pos, 0);
    Row* const mid_neg = face(Side::mid_neg, here_);
    Row* const mid_pos = face(Side::mid_pos, here_);
    Row* const fast_neg = face(Side::fast_neg, here_);
    Row* const fast_pos = face(Side::fast_pos, here_);
    const Row* const mid_neg_there = face(Side::mid_neg, there_);
    const Row* const mid_pos_there = face(Side::mid_pos, there_);
    const Row* const fast_neg_there = face(Side::fast_neg, there_);
    const Row* const fast_pos_there = face(Side::fast_pos, there_);
    const Row hide_neg = hide_fast(Side::fast_neg, s);
    const Row hide_pos = hide_fast(Side::fast_pos, s);
    const Row last = last_;
    std::array<RowSet, 6> rows{};
    for (std::uint32_t m = 0; m < count; m += kLanes) {
      const V own = Lanes::load(solid + m);
      const V hide = Lanes::load(hiding + m);
      V f_mid_neg = Lanes::without(own, Lanes::load(hiding + m - 1));
      V f_mid_pos = Lanes::without(own, Lanes::load(hiding + m + 1));
      V f_fast_neg = Lanes::without(
          own, Lanes::either(Lanes::template up<1>(hide), Lanes::where(low_lanes(hide_neg, m), Row{1})));
      V f_fast_pos =
          Lanes::without(own, Lanes::either(Lanes::down(hide), Lanes::where(low_lanes(hide_pos, m), last)));
      V f_slow_neg = Lanes::without(own, Lanes::load(hiding_there + m));
      V f_slow_pos = Lanes::without(Lanes::load(solid_there + m), hide);
      // The same faces a row before, for the slow sides.
      V g_slow_neg = Lanes::without(Lanes::load(solid + m - 1), Lanes::load(hiding_there + m - 1));
      V g_slow_pos = Lanes::without(Lanes::load(solid_there + m - 1), Lanes::load(hiding + m - 1));
      V along = own;    // bits at which strips along a row are cut other than in the layer before
      V between = own;  // where the material differs from the layer before
      V along_neg = own, along_pos = own;
      if constexpr (kNumbered) {
        const V fast = Lanes::load(cut_fast + m);
        const V mid = Lanes::load(cut_mid + m);
        between = Lanes::load(cut_slow + m);
        const V slow_before = Lanes::load(cut_slow + m - 1);
        const V fast_there = Lanes::load(cut_fast_there + m);
        const V mid_there = Lanes::load(cut_mid_there + m);
        f_mid_neg = Lanes::both(f_mid_neg, mid);
        f_mid_pos = Lanes::both(f_mid_pos, Lanes::load(cut_mid + m + 1));
        f_fast_neg = Lanes::both(f_fast_neg, fast);
        f_fast_pos = Lanes::both(f_fast_pos, Lanes::either(Lanes::down(fast), Lanes::all(last)));
        f_slow_neg = Lanes::both(f_slow_neg, between);
        f_slow_pos = Lanes::both(f_slow_pos, between);
        g_slow_neg = Lanes::both(g_slow_neg, slow_before);
        g_slow_pos = Lanes::both(g_slow_pos, slow_before);
        along = Lanes::either(between, Lanes::differing(fast, fast_there));
        along_neg = Lanes::either(mid, Lanes::differing(fast, Lanes::load(cut_fast + m - 1)));
        along_pos =
            Lanes::either(mid_there, Lanes::differing(fast_there, Lanes::load(cut_fast_there + m - 1)));
      }
      Lanes::store(f_slow_neg, slow_neg + m);
      Lanes::store(f_slow_pos, slow_pos + m);
      Lanes::store(f_mid_neg, mid_neg + m);
      Lanes::store(f_mid_pos, mid_pos + m);
      Lanes::store(f_fast_neg, fast_neg + m);
      Lanes::store(f_fast_pos, fast_pos + m);
      add_rows(rows[0], differ(f_slow_neg, g_slow_neg, along_neg), m);
      add_rows(rows[1], differ(f_slow_pos, g_slow_pos, along_pos), m);
      add_rows(rows[2], differ(f_mid_neg, Lanes::load(mid_neg_there + m), along), m);
      add_rows(rows[3], differ(f_mid_pos, Lanes::load(mid_pos_there + m), along), m);
      add_rows(rows[4], differ(f_fast_neg, Lanes::load(fast_neg_there + m), between), m);
      add_rows(rows[5], differ(f_fast_pos, Lanes::load(fast_pos_there + m), between), m);
    }
    // Rows behind the last one have no faces, so the first of them closes what is open, if it was met.
    const Row valid = bits_below<Row>(count);
    for (RowSet& set : rows) set &= valid;
    slow_strips<Side::slow_neg>(rows[0], s, here_);
    if (s != 0) slow_strips<Side::slow_pos>(rows[1], s - 1, there_);
    level_strips<Side::mid_neg>(rows[2], s);
    level_strips<Side::mid_pos>(rows[3], s);
    upright_strips<Side::fast_neg>(rows[4], s);
    upright_strips<Side::fast_pos>(rows[5], s);
  }
  static HWY_INLINE std::uint64_t low_lanes(Row set, std::uint32_t m) {
    return static_cast<std::uint64_t>(set >> m);
  }
  /// Lanes in which faces now and before differ, or are cut otherwise.
  static HWY_INLINE std::uint64_t differ(V now, V before, [[maybe_unused]] V cut) {
    V x = Lanes::differing(now, before);
    if constexpr (kNumbered) x = Lanes::either(x, Lanes::both(now, cut));
    return Lanes::any(x);
  }

  using Strips = RowStrips<Row>;
  static HWY_INLINE Row cut_at(const Row* cut) { return kNumbered ? *cut : Row{0}; }

  /// What the rectangles of one side need to become quads. A value, so that the compiler may keep it in
  /// registers while bytes are written.
  struct Outlet {
    QuadShape shape;
    QuadBuckets::Bucket* opaque;
    QuadBuckets::Bucket* transparent;
    const C* layer;  // the codes of the strips' voxels
    std::uint32_t line_size;
    const MaterialCodes* codes;
    bool mixed;
    Material single;  // the material, if there is but one
  };
  HWY_INLINE Outlet outlet(Side side, unsigned ring) {
    const Direction direction = in_.direction[at(side)];
    const bool clear = !kNumbered && in_.codes->has_transparent();
    return {in_.shape[at(side)],
            (clear ? in_.transparent : in_.opaque)->of(direction),
            in_.transparent->of(direction),
            codes(ring),
            e_.f,
            in_.codes,
            mixed_,
            kNumbered ? kEmpty : in_.codes->single()};
  }

  /// Says in an open quad that it is for the transparent pass; zero in a closed one.
  static constexpr std::uint64_t kTransparentQuad = std::uint64_t{1} << 63;

  /// The quad of a strip whose material is that of bit `bit` of row `line`.
  static HWY_INLINE Quad open_quad(const Outlet& out, const Strip& strip, [[maybe_unused]] std::uint32_t line,
                                   [[maybe_unused]] unsigned bit) {
    if constexpr (!kNumbered) {
      return out.shape.open(strip, out.single);
    } else {
      const C code = out.layer[line * out.line_size + bit];
      Quad quad = out.shape.open(strip, out.codes->material(code));
      if (out.mixed && whole_code(code) >= kTransparentBit) quad.bits ^= kTransparentQuad;
      return quad;
    }
  }
  static HWY_INLINE void close_quad(const Outlet& out, Quad open, std::uint32_t layer, std::uint32_t row) {
    Quad quad = out.shape.close(open, row);
    QuadBuckets::Bucket* buckets = out.opaque;
    if (kNumbered && (quad.bits & kTransparentQuad) != 0) {
      quad.bits ^= kTransparentQuad;
      buckets = out.transparent;
    }
    QuadBuckets::put(buckets[layer], quad);
  }

  /// Closes the strips that end at the bits of `closing` before row `row`.
  static HWY_INLINE void close_strips(const Outlet& out, Row closing, const Quad* open, std::uint32_t layer,
                                      std::uint32_t row) {
    if (closing == 0) return;
    if (kNumbered && out.mixed) {
      for (; closing != 0; closing &= closing - 1) close_quad(out, open[lowest_bit(closing)], layer, row);
      return;
    }
    QuadBuckets::Bucket& bucket = out.opaque[layer];
    Quad* const to = QuadBuckets::reserve(bucket, kRowBits<Row>);
    Quad* next = to;
    for (; closing != 0; closing &= closing - 1) {
      *next++ = out.shape.close(open[lowest_bit(closing)], row);
    }
    bucket.count += static_cast<std::uint32_t>(next - to);
  }
  /// Opens the strips that end at the bits of `opening` and begin at bits of `start`, in row `row`. Their
  /// material is that of row `line`.
  static HWY_INLINE void open_strips(const Outlet& out, Row opening, Row start, Quad* open,
                                     std::uint32_t layer, std::uint32_t row, std::uint32_t line) {
    for (; opening != 0; opening &= opening - 1) {
      const unsigned end = lowest_bit(opening);
      const unsigned begin = highest_bit(start & (opening ^ (opening - 1)));
      open[end] = open_quad(out, {layer, begin, end - begin + 1, row}, line, begin);
    }
  }

  /// Whether so many rows change that all of them at once cost less than these one by one.
  bool most([[maybe_unused]] RowSet rows, unsigned part = 1) const {
    if constexpr (kLanes == 1) {
      return false;
    } else {
      return static_cast<std::uint32_t>(std::popcount(rows)) * kLanes * part > e_.m;
    }
  }

  /// The functions of row_strips.hpp for whole vectors of rows.
  struct Vectors {
    V face, start, end;
  };
  static HWY_INLINE Vectors between(V face, V before, V behind) {
    return {face, Lanes::without(face, before), Lanes::without(face, behind)};
  }
  static HWY_INLINE Vectors vectors_along(const Row* face, [[maybe_unused]] const Row* cut) {
    const V f = Lanes::load(face);
    V before = Lanes::template up<1>(f);
    V behind = Lanes::down(f);
    if constexpr (kNumbered) {
      const V c = Lanes::load(cut);
      before = Lanes::without(before, c);
      behind = Lanes::without(behind, Lanes::down(c));
    }
    return between(f, before, behind);
  }
  static HWY_INLINE V vectors_changed(const Vectors& now, const Vectors& before,
                                      [[maybe_unused]] const Row* cut) {
    V x = Lanes::either(
        Lanes::differing(now.face, before.face),
        Lanes::either(Lanes::differing(now.start, before.start), Lanes::differing(now.end, before.end)));
    if constexpr (kNumbered) {
      x = Lanes::either(x, Lanes::both(Lanes::both(now.face, before.face), Lanes::load(cut)));
    }
    return x;
  }
  static HWY_INLINE V vectors_ends_with(const Vectors& strips, V x) {
    x = Lanes::both(x, strips.face);
    const V inner = Lanes::without(strips.face, strips.end);
    return Lanes::both(strips.end, Lanes::either(x, Lanes::sum(inner, Lanes::both(x, inner))));
  }

  /// Rows of strips, their cuts, and where the material differs from the row before.
  struct Lines {
    const Row *face, *cut, *face_before, *cut_before, *differs;
  };
  /// What close_strips() and open_strips() ask for, for all rows: closing, opening, start.
  void compare_along(const Lines& in) {
    Row* const closing = st_.strips[0].data();
    Row* const opening = st_.strips[1].data();
    Row* const start = st_.strips[2].data();
    for_rows([=](std::uint32_t m) {
      const Vectors now = vectors_along(in.face + m, in.cut + m);
      const Vectors before = vectors_along(in.face_before + m, in.cut_before + m);
      const V x = vectors_changed(now, before, in.differs + m);
      Lanes::store(vectors_ends_with(before, x), closing + m);
      Lanes::store(vectors_ends_with(now, x), opening + m);
      Lanes::store(now.start, start + m);
    });
  }
  /// Closes and opens what compare_along() found, in the rows that differ.
  HWY_INLINE void strips_found(const Outlet& out, std::uint32_t m, Quad* open, std::uint32_t layer,
                               std::uint32_t row) {
    close_strips(out, st_.strips[0].data()[m], open, layer, row);
    open_strips(out, st_.strips[1].data()[m], st_.strips[2].data()[m], open, layer, row, m);
  }

  /// Faces across the slowest axis of layer `layer`, in ring `own`. A row is a line.
  template <Side kSide>
  void slow_strips(RowSet rows, std::uint32_t layer, unsigned own) {
    const Row* const face = st_.face[at(kSide)][0].data();
    const std::uint32_t count = e_.m;
    const Row bottom = face[count - 1];
    if (rows == 0 && bottom == 0) return;
    const Row* const cut_fast = st_.cut_fast[own].data();
    const Row* const cut_mid = st_.cut_mid[own].data();
    const Outlet out = outlet(kSide, own);
    Quad* const open = st_.open[at(kSide)].data();
    if (most(rows)) {
      compare_along({face, cut_fast, face - 1, cut_fast - 1, cut_mid});
      for (; rows != 0; rows &= rows - 1) {
        const std::uint32_t m = lowest_bit(rows);
        strips_found(out, m, open, layer, m);
      }
    }
    for (; rows != 0; rows &= rows - 1) {
      const std::uint32_t m = lowest_bit(rows);
      const Strips now = strips_along<Row>(face[m], cut_at(cut_fast + m));
      const Strips before = m == 0 ? Strips{} : strips_along<Row>(face[m - 1], cut_at(cut_fast + m - 1));
      const Row x = changed<Row>(now, before, cut_at(cut_mid + m));
      close_strips(out, ends_with(before, x), open, layer, m);
      open_strips(out, ends_with(now, x), now.start, open, layer, m, m);
    }
    const Strips over = strips_along<Row>(bottom, cut_at(cut_fast + count - 1));
    close_strips(out, over.end, open, layer, count);
  }

  /// Places of bits in a layer: row * kRowBits + bit. Written down first and gone through afterwards, so that
  /// the loop over them has no end in each row that a processor would have to foresee.
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

  /// Faces across the middle axis in layer s. A row is the line of a layer, its next one that of the next.
  template <Side kSide>
  void level_strips(RowSet rows, std::uint32_t s) {
    if (rows == 0) return;
    const Row* const face = st_.face[at(kSide)][here_].data();
    const Row* const face_before = st_.face[at(kSide)][there_].data();
    const Row* const cut_fast = st_.cut_fast[here_].data();
    const Row* const cut_fast_before = st_.cut_fast[there_].data();
    const Row* const cut_slow = st_.cut_slow.data();
    const Outlet out = outlet(kSide, here_);
    Quad* const open = st_.open[at(kSide)].data();
    Row* const closing = st_.strips[0].data();
    Row* const opening = st_.strips[1].data();
    Row* const start = st_.strips[2].data();
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
    for (const Place* at = closed; at != closed_end; ++at) {
      close_quad(out, open[*at], *at / kRowBits<Row>, s);
    }
    for (const Place* at = opened; at != opened_end; ++at) {
      const std::uint32_t m = *at / kRowBits<Row>;
      const unsigned end = *at % kRowBits<Row>;
      const unsigned begin = highest_bit(start[m] & (~Row{0} >> (kRowBits<Row> - 1 - end)));
      open[*at] = open_quad(out, {m, begin, end - begin + 1, s}, m, begin);
    }
  }

  /// Faces across the fastest axis in layer s: every bit is a layer of its own. Strips run along the slowest
  /// axis, one a bit: a face that appears begins one, a face that disappears ends one. Those that end side by
  /// side in neighbouring rows are one quad if they began together and are of one material.
  template <Side kSide>
  void upright_strips(RowSet rows, std::uint32_t s) {
    if (rows == 0) return;
    const Row* const face = st_.face[at(kSide)][here_].data();
    const Row* const face_before = st_.face[at(kSide)][there_].data();
    const Row* const cut_mid_before = st_.cut_mid[there_].data();
    const Row* const cut_slow = st_.cut_slow.data();
    const Outlet out = outlet(kSide, there_);
    std::uint8_t* const born = st_.born[at(kSide) - at(Side::fast_neg)].data();
    Row* const beside = st_.strips[0].data();  // bits that close in the row before as well, cut or not
    Place* const closed = st_.closed.data();
    Place* closed_end = closed;
    Row above = 0;
    std::uint32_t next = 0;
    for (RowSet left = rows; left != 0; left &= left - 1) {
      const std::uint32_t m = lowest_bit(left);
      const Row closing = face_before[m] & (~face[m] | cut_at(cut_slow + m));
      beside[m] = m == next ? above & ~cut_at(cut_mid_before + m) : Row{0};
      closed_end = write_places(closing, m, closed_end);
      above = closing;
      next = m + 1;
    }
    for (const Place* at = closed; at != closed_end; ++at) {
      const std::uint32_t m = *at / kRowBits<Row>;
      const unsigned bit = *at % kRowBits<Row>;
      const std::uint32_t first = born[*at];
      // Row 0 has nothing beside it; it may read any byte.
      const bool joins = (beside[m] >> bit & 1) != 0 && born[*at - (m == 0 ? 0 : kRowBits<Row>)] == first;
      join_quad(out, open_quad(out, {bit, first, s - first, m}, m, bit), bit, m + 1, joins);
    }
    for (RowSet left = rows; left != 0; left &= left - 1) {
      const std::uint32_t m = lowest_bit(left);
      const Row opening = face[m] & (~face_before[m] | cut_at(cut_slow + m));
      CodeLanes::template put<Row>(opening, static_cast<std::uint8_t>(s),
                                   born + std::size_t{m} * kRowBits<Row>);
    }
  }
  /// Closes a quad of one row; or, if it joins it, adds its row to the quad that was last put into that layer.
  static HWY_INLINE void join_quad(const Outlet& out, Quad open, std::uint32_t layer, std::uint32_t row_end,
                                   bool joins) {
    Quad quad = out.shape.close(open, row_end);
    QuadBuckets::Bucket* buckets = out.opaque;
    if (kNumbered && (quad.bits & kTransparentQuad) != 0) {
      quad.bits ^= kTransparentQuad;
      buckets = out.transparent;
    }
    QuadBuckets::Bucket& bucket = buckets[layer];
    if (bucket.count == bucket.room) QuadBuckets::grow(bucket);
    // Without a branch: which of the two it is cannot be foreseen.
    bucket.count -= joins ? 1 : 0;
    Quad* const to = bucket.quads.get() + bucket.count++;
    *to = joins ? out.shape.with_row_more(*to) : quad;
  }

  /// Closes what reaches the last layer: as if one without faces followed it.
  void finish() {
    hide_slow(Side::slow_pos, here_, there_);
    Row* const slow_pos = st_.face[at(Side::slow_pos)][0].data();
    const Row* const solid = st_.solid[there_].data();
    const Row* const hiding = st_.hiding[here_].data();
    for (std::uint32_t m = 0; m < e_.m; ++m) slow_pos[m] = solid[m] & ~hiding[m];
    std::array<RowSet, 6> rows{};
    for (std::uint32_t m = 0; m < e_.m; ++m) {
      rows[at(Side::slow_pos)] |= Row{slow_pos[m] != 0 || (m != 0 && slow_pos[m - 1] != 0)} << m;
    }
    for (unsigned side = at(Side::mid_neg); side <= at(Side::fast_pos); ++side) {
      const Row* const before = st_.face[side][there_].data();
      Row* const none = st_.face[side][here_].data();
      for (std::uint32_t m = 0; m < e_.m; ++m) {
        rows[side] |= Row{before[m] != 0} << m;
        none[m] = 0;
      }
    }
    slow_strips<Side::slow_pos>(rows[at(Side::slow_pos)], e_.s - 1, there_);
    level_strips<Side::mid_neg>(rows[at(Side::mid_neg)], e_.s);
    level_strips<Side::mid_pos>(rows[at(Side::mid_pos)], e_.s);
    upright_strips<Side::fast_neg>(rows[at(Side::fast_neg)], e_.s);
    upright_strips<Side::fast_pos>(rows[at(Side::fast_pos)], e_.s);
  }

  const SweepInput& in_;
  const Borders<Row>& borders_;
  SweepState<Row>& st_;
  const OrderedExtent e_;
  typename SweepState<Row>::template Codes<C>& codes_;
  const bool mixed_;
  const Row valid_, last_;
  std::size_t run_ = 0;
  unsigned here_ = 0, there_ = 1;  // rings of the layer at hand and the one before it
};

template <class Lanes, class CodeLanes>
void sweep(const SweepInput& input, const Borders<typename Lanes::Row>& borders,
           SweepState<typename Lanes::Row>& state) {
  if (input.codes->solid_count() == 1) {
    Sweep<Lanes, CodeLanes, ByteCode, false>(input, borders, state).run();
  } else if (input.codes->fit_bytes()) {
    Sweep<Lanes, CodeLanes, ByteCode, true>(input, borders, state).run();
  } else {
    Sweep<Lanes, CodeLanes, Code, true>(input, borders, state).run();
  }
}

void sweep_64(const SweepInput& input, const Borders<Row64>& borders, SweepState<Row64>& state) {
  sweep<VectorRows, VectorCodes>(input, borders, state);
}
void sweep_128(const SweepInput& input, const Borders<Row128>& borders, SweepState<Row128>& state) {
  sweep<OneRow<Row128>, VectorCodes>(input, borders, state);
}
void sweep_plain(const SweepInput& input, const Borders<Row64>& borders, SweepState<Row64>& state) {
  sweep<OneRow<Row64>, PlainCodes>(input, borders, state);
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
