// LayerBuilder: makes the codes of one layer after the other from the runs, and from them its rows of bits: what
// has faces, what hides them, inside the chunk and beyond its borders, and where the material changes.
// Included once per instruction set, inside no namespace.
#if defined(RUNSTONE_MESH_RDM_LAYER_BUILDER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_MESH_RDM_LAYER_BUILDER_INL
#undef RUNSTONE_MESH_RDM_LAYER_BUILDER_INL
#else
#define RUNSTONE_MESH_RDM_LAYER_BUILDER_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "common/mesh/rdm/row_lanes-inl.hpp"
#include "common/mesh/rdm/sweep_input.hpp"
#include "common/mesh/rdm/sweep_state.hpp"
#include "common/runs/bit_row.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

/// Form: a SweepTraits.
template <class Form>
class LayerBuilder {
  using Lanes = typename Form::Lanes;
  using CodeLanes = typename Form::CodeLanes;
  using Row = typename Form::Row;
  using C = typename Form::C;
  using Line = typename Form::Line;
  using Rows = LayerRows<Row>;
  static constexpr bool kNumbered = Form::kNumbered;
  static_assert(CodeLanes::template kBehind<C> <= LayerCodes<Row, C>::kRoom);

 public:
  LayerBuilder(const SweepInput& input, const Borders<Row>& borders, SweepState<Row>& state)
      : in_(input),
        borders_(borders),
        st_(state),
        codes_(state.template codes<C>()),
        e_(input.extent),
        mixed_(kNumbered && input.codes->has_transparent()),
        valid_(bits_below<Row>(input.extent.f)) {}

  /// Goes on to layer s, which is 0 or the one above the last. Each is gone to, built or not.
  void go_to(std::uint32_t s) {
    if (runs()[run_].end == s * e_.layer()) ++run_;
  }

  /// Whether layer s, gone to, is of one material and so was the one before, with equal borders: nothing
  /// begins or ends then, and the layer need not be built. Requires s != 0.
  bool repeats(std::uint32_t s) const {
    const std::uint32_t begin = s * e_.layer();
    const CodedRun& run = runs()[run_];
    const std::uint32_t run_begin = run_ == 0 ? 0 : runs()[run_ - 1].end;
    if (run_begin + e_.layer() > begin || run.end < begin + e_.layer()) return false;
    if (run.code == 0) return true;
    for (const Side side : kLayerSides) {
      if (borders_.hiding[at(side)][s] != borders_.hiding[at(side)][s - 1]) return false;
      if (borders_.meets[at(side)] && (run.code & kTransparentBit) != 0) return false;
    }
    return true;
  }

  /// Makes the codes and the rows of layer s, gone to, from the runs that lie in it.
  void build(std::uint32_t s, LayerPair layers) {
    decode(s, codes_[layers.current].data());
    const C* line = codes_[layers.current].data();
    const C* line_there = codes_[layers.previous].data();
    Row* const solid = st_.solid[layers.current].data();
    Row* const hiding = st_.hiding[layers.current].data();
    Row* const transparent = st_.transparent.data();
    Row* const fast = st_.cut_fast[layers.current].data();
    Row* const mid = st_.cut_mid[layers.current].data();
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
    hiding[-1] = hide_middle(Side::mid_neg, s, codes_[layers.current].data());
    hiding[count] =
        hide_middle(Side::mid_pos, s, codes_[layers.current].data() + (count - 1) * e_.f);
  }

  /// Puts what lies beyond a slow side into the hiding rows of `ring`, as if it were a layer; `own` is the
  /// ring of our layer there.
  void hide_slow(Side side, unsigned ring, [[maybe_unused]] unsigned own) {
    Row* const hiding = st_.hiding[ring].data();
    std::copy_n(borders_.hiding[at(side)].data(), e_.m, hiding);
    if constexpr (kNumbered) {
      if (!borders_.meets[at(side)]) return;
      const C* line = codes_[own].data();
      for (std::uint32_t m = 0; m < e_.m; ++m, line += e_.f)
        hiding[m] |= same_beyond_line(side, m, line);
    }
  }

  /// What hides the faces of a fast side in layer s, which was built last, in ring `own`: bit m is line m.
  Row hide_fast(Side side, std::uint32_t s, [[maybe_unused]] unsigned own) const {
    Row hide = borders_.hiding[at(side)][s];
    if constexpr (kNumbered) {
      if (borders_.meets[at(side)]) {
        const unsigned bit = side == Side::fast_neg ? 0 : e_.f - 1;
        const Row ours = column_of<Lanes, Row>(st_.transparent.data(), e_.m, Row{1} << bit);
        const C* const column = codes_[own].data() + bit;
        hide |= same_beyond(side, s, e_.m, ours,
                            [column, f = e_.f](unsigned m) { return column[m * f]; });
      }
    }
    return hide;
  }

 private:
  const CodedRun* runs() const { return in_.runs.data(); }

  /// Writes the codes of layer s to `first`, and some behind them.
  void decode(std::uint32_t s, C* first) {
    const std::uint32_t begin = s * e_.layer();
    const std::uint32_t end = begin + e_.layer();
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

  /// What hides the faces of a middle side in layer s; `line` is ours there.
  Row hide_middle(Side side, std::uint32_t s, [[maybe_unused]] const C* line) const {
    Row hide = borders_.hiding[at(side)][s];
    if constexpr (kNumbered) {
      if (borders_.meets[at(side)]) hide |= same_beyond_line(side, s, line);
    }
    return hide;
  }

  /// Where transparent voxels of ours meet their own kind beyond a border, in its row `row` of `bits` voxels:
  /// `ours` are the transparent ones of our row there, and `code_at(bit)` their codes.
  template <class CodeAt>
  Row same_beyond(Side side, std::uint32_t row, std::uint32_t bits, Row ours,
                  CodeAt&& code_at) const {
    Row same = ours & borders_.transparent[at(side)][row];
    if (const auto& theirs = borders_.codes[at(side)]; !theirs.empty()) {
      for (Row left = same; left != 0; left &= left - 1) {
        const unsigned bit = lowest_bit(left);
        if (whole_code(code_at(bit)) != theirs[std::size_t{row} * bits + bit])
          same ^= Row{1} << bit;
      }
    }
    return same;
  }
  /// The same for a line of ours.
  Row same_beyond_line(Side side, std::uint32_t row, const C* line) const {
    const Row ours = Line::at(line).transparent() & valid_;
    return same_beyond(side, row, e_.f, ours, [line](unsigned bit) { return line[bit]; });
  }

  const SweepInput& in_;
  const Borders<Row>& borders_;
  SweepState<Row>& st_;
  typename SweepState<Row>::template Codes<C>& codes_;
  const OrderedExtent e_;
  const bool mixed_;     // whether there are transparent materials besides others
  const Row valid_;      // bits of a line
  std::size_t run_ = 0;  // the first that lies in the layer at hand
};

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
