// LayerBuilder: writes the palette indices of one layer after another from the runs, and from the
// indices the rows of bits: the voxels with faces, the voxels that hide faces (inside the chunk and
// beyond its borders), and the places where the material changes. Highway includes this file once
// per instruction set, outside of any namespace.
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

/// Traits: a SweepTraits.
template <class Traits>
class LayerBuilder {
  using Lanes = typename Traits::Lanes;
  using IndexLanes = typename Traits::IndexLanes;
  using Row = typename Traits::Row;
  using Index = typename Traits::Index;
  using Line = typename Traits::Line;
  using Rows = LayerRows<Row>;
  static constexpr bool kManyMaterials = Traits::kManyMaterials;
  static_assert(IndexLanes::template kBehind<Row, Index> <= LayerIndices<Row, Index>::kRoom);

 public:
  LayerBuilder(const SweepInput& input, const Borders<Row>& borders, SweepState<Row>& state)
      : runs_(input.runs),
        borders_(borders),
        st_(state),
        indices_(state.template indices<Index>()),
        e_(input.extent),
        mixed_(kManyMaterials && input.palette->has_transparent()),
        valid_(bits_below<Row>(input.extent.f)) {}

  /// Advances to layer s. Call it once per layer, in order from 0, even for layers that are not
  /// built.
  void advance_to(std::uint32_t s) {
    if (runs_.end(run_) == s * e_.layer()) ++run_;
  }

  /// Returns true if the current layer s and the previous one are of the same single material and
  /// have equal borders. Then no strip begins or ends, and the layer need not be built. Requires s
  /// != 0.
  bool repeats(std::uint32_t s) const {
    const std::uint32_t begin = s * e_.layer();
    const std::uint32_t run_begin = run_ == 0 ? 0 : runs_.end(run_ - 1);
    if (run_begin + e_.layer() > begin || runs_.end(run_) < begin + e_.layer()) return false;
    const PaletteIndex index = full_index(runs_.template index<Index>(run_));
    if (index == 0) return true;
    for (const Side side : kLayerSides) {
      if (borders_.hiding[at(side)][s] != borders_.hiding[at(side)][s - 1]) return false;
      if (borders_.meets[at(side)] && (index & kTransparentBit) != 0) return false;
    }
    return true;
  }

  /// Writes the indices and the rows of the current layer s from the runs that lie in it.
  void build(std::uint32_t s, LayerPair layers) {
    decode(s, indices_[layers.current].data());
    const Index* line = indices_[layers.current].data();
    const Index* line_previous = indices_[layers.previous].data();
    Row* const solid = st_.solid[layers.current].data();
    Row* const hiding = st_.hiding[layers.current].data();
    Row* const transparent = st_.transparent.data();
    Row* const fast = st_.cut_fast[layers.current].data();
    Row* const mid = st_.cut_mid[layers.current].data();
    Row* const slow = st_.cut_slow.data();
    const std::uint32_t count = e_.m;
    Line above = Line::at(line - e_.f);
    for (std::uint32_t m = 0; m < count; ++m, line += e_.f, line_previous += e_.f) {
      const Line current = Line::at(line);
      const Row faced = current.solid() & valid_;
      solid[m] = faced;
      hiding[m] = faced;
      if constexpr (kManyMaterials) {
        if (mixed_) {
          transparent[m] = current.transparent() & valid_;
          hiding[m] = faced & ~transparent[m];
        }
        fast[m] = differing(current, Line::at(line - 1)) | 1;
        mid[m] = differing(current, above);
        slow[m] = differing(current, Line::at(line_previous));
        above = current;
      }
    }
    std::fill_n(solid + count, Rows::kBehind, Row{0});
    if constexpr (kManyMaterials) {
      mid[0] = mid[count] = ~Row{0};
      if (s == 0) std::fill_n(slow, count, ~Row{0});
    }
    hiding[-1] = hide_middle(Side::mid_neg, s, indices_[layers.current].data());
    hiding[count] =
        hide_middle(Side::mid_pos, s, indices_[layers.current].data() + (count - 1) * e_.f);
  }

  /// Writes the voxels beyond a slow side into the hiding rows of slot `slot`, as if they were a
  /// layer. `chunk_slot` is the slot of the chunk's layer at that side.
  void hide_slow(Side side, unsigned slot, [[maybe_unused]] unsigned chunk_slot) {
    Row* const hiding = st_.hiding[slot].data();
    std::copy_n(borders_.hiding[at(side)].data(), e_.m, hiding);
    if constexpr (kManyMaterials) {
      if (!borders_.meets[at(side)]) return;
      const Index* line = indices_[chunk_slot].data();
      for (std::uint32_t m = 0; m < e_.m; ++m, line += e_.f)
        hiding[m] |= same_beyond_line(side, m, line);
    }
  }

  /// Returns the bits that hide the faces of a fast side in layer s: bit m is line m. Layer s is
  /// the last built layer, in slot `slot`.
  Row hide_fast(Side side, std::uint32_t s, [[maybe_unused]] unsigned slot) const {
    Row hide = borders_.hiding[at(side)][s];
    if constexpr (kManyMaterials) {
      if (borders_.meets[at(side)]) {
        const unsigned bit = side == Side::fast_neg ? 0 : e_.f - 1;
        const Row ours = column_of<Lanes, Row>(st_.transparent.data(), e_.m, Row{1} << bit);
        const Index* const column = indices_[slot].data() + bit;
        hide |= same_beyond(side, s, e_.m, ours,
                            [column, f = e_.f](unsigned m) { return column[m * f]; });
      }
    }
    return hide;
  }

 private:
  /// Writes the indices of layer s to `first`, and some behind them.
  void decode(std::uint32_t s, Index* first) {
    const std::uint32_t begin = s * e_.layer();
    const std::uint32_t end = begin + e_.layer();
    // A copy in registers: for the compiler, a write of bytes may change the members.
    const IndexedRuns runs = runs_;
    Index* to = first;
    std::size_t run = run_;
    for (std::uint32_t run_end; (run_end = runs.end(run)) < end; ++run) {
      Index* const stop = first + (run_end - begin);
      IndexLanes::template fill<Row>(to, stop, runs.template index<Index>(run));
      to = stop;
    }
    IndexLanes::template fill<Row>(to, first + e_.layer(), runs.template index<Index>(run));
    run_ = run;
  }

  /// Returns the bits that hide the faces of a middle side in layer s. `line` is the chunk's line
  /// at that side.
  Row hide_middle(Side side, std::uint32_t s, [[maybe_unused]] const Index* line) const {
    Row hide = borders_.hiding[at(side)][s];
    if constexpr (kManyMaterials) {
      if (borders_.meets[at(side)]) hide |= same_beyond_line(side, s, line);
    }
    return hide;
  }

  /// Returns the bits at which a transparent voxel of the chunk touches its own material beyond a
  /// border, in row `row` of `bits` voxels. `ours` marks the chunk's transparent voxels of that
  /// row, and `index_at(bit)` returns their indices.
  template <class IndexAt>
  Row same_beyond(Side side, std::uint32_t row, std::uint32_t bits, Row ours,
                  IndexAt&& index_at) const {
    Row same = ours & borders_.transparent[at(side)][row];
    if (const auto& theirs = borders_.indices[at(side)]; !theirs.empty()) {
      for (Row left = same; left != 0; left &= left - 1) {
        const unsigned bit = lowest_bit(left);
        const PaletteIndex index =
            theirs.size() == 1 ? theirs.front() : theirs[std::size_t{row} * bits + bit];
        if (full_index(index_at(bit)) != index) same ^= Row{1} << bit;
      }
    }
    return same;
  }
  /// Returns the bits at which a transparent voxel of a line of the chunk touches its own material
  /// beyond a border.
  Row same_beyond_line(Side side, std::uint32_t row, const Index* line) const {
    const Row ours = Line::at(line).transparent() & valid_;
    return same_beyond(side, row, e_.f, ours, [line](unsigned bit) { return line[bit]; });
  }

  const IndexedRuns runs_;
  const Borders<Row>& borders_;
  SweepState<Row>& st_;
  typename SweepState<Row>::template Indices<Index>& indices_;
  const OrderedExtent e_;
  const bool mixed_;     // some materials are transparent and others are not
  const Row valid_;      // bits of a line
  std::size_t run_ = 0;  // the first run that lies in the current layer
};

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
