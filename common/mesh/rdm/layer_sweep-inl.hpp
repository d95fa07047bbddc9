// Sweep: the loop over the layers of a chunk (layer_sweep.hpp). Included once per instruction set,
// inside no namespace.
#if defined(RUNSTONE_MESH_RDM_LAYER_SWEEP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_MESH_RDM_LAYER_SWEEP_INL
#undef RUNSTONE_MESH_RDM_LAYER_SWEEP_INL
#else
#define RUNSTONE_MESH_RDM_LAYER_SWEEP_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/chunk_sides-inl.hpp"
#include "common/mesh/rdm/index_lanes-inl.hpp"
#include "common/mesh/rdm/layer_builder-inl.hpp"
#include "common/mesh/rdm/row_lanes-inl.hpp"
#include "common/mesh/rdm/strip_tracer-inl.hpp"
#include "common/mesh/rdm/sweep_part.hpp"
#include "common/mesh/rdm/sweep_traits.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

/// One call of sweep_layers() or sweep_layers_plain(). Traits: a SweepTraits.
template <class Traits>
class Sweep {
  using Lanes = typename Traits::Lanes;
  using Row = typename Traits::Row;
  using V = typename Lanes::V;
  using Rows = LayerRows<Row>;
  using Tracer = StripTracer<Traits>;
  using RowSet = typename Tracer::RowSet;
  static constexpr bool kManyMaterials = Traits::kManyMaterials;

 public:
  Sweep(const SweepInput& input, const Borders<Row>& borders, const SweepPart<Row>& part,
        SweepState<Row>& state)
      : st_(state),
        e_(input.extent),
        part_(part),
        is_whole_(part == SweepPart<Row>::whole(input.extent)),
        wants_chunk_sides_(input.chunk_sides),
        builder_(input, borders, state),
        chunk_sides_(input, state),
        tracer_(input, state) {}

  void run() {
    start();
    if (part_.begin != 0) {
      builder_.build(part_.begin - 1, layers_);
      find_faces(part_.begin - 1);
      std::swap(layers_.current, layers_.previous);
    }
    const std::uint32_t read_end = part_.read_end(e_);
    for (std::uint32_t s = part_.begin; s < read_end; ++s) {
      builder_.advance_to(s);
      if (s != 0 && builder_.repeats(s)) {
        if (wants_chunk_sides_) chunk_sides_.find(s, layers_.previous);
        continue;
      }
      builder_.build(s, layers_);
      if (wants_chunk_sides_) chunk_sides_.find(s, layers_.current);
      if (s == 0) builder_.hide_slow(Side::slow_neg, layers_.previous, layers_.current);
      trace(find_faces(s), s);
      std::swap(layers_.current, layers_.previous);
    }
    if (part_.end == e_.s) trace(end_faces(), e_.s);
  }

 private:
  /// The rows in which strips may end or begin, by Side.
  using SideRows = std::array<RowSet, 6>;

  /// Prepares the state as if a layer without faces preceded the first one.
  void start() {
    const auto clear = [this](Rows& rows) {
      std::fill_n(rows.data(), e_.m + Rows::kBehind, Row{0});
    };
    clear(st_.solid[layers_.previous]);
    for (const Side side : kLayerSides) {
      clear(st_.face[at(side)][layers_.previous]);
      clear(st_.face[at(side)][layers_.current]);
    }
    if constexpr (kManyMaterials) {
      clear(st_.cut_fast[layers_.previous]);
      clear(st_.cut_mid[layers_.previous]);
    }
  }

  /// Finds the faces of layer s: those across the middle and the fastest axis, and those between
  /// this layer and the previous one. Returns by side the rows that differ from their previous row.
  SideRows find_faces(std::uint32_t s) {
    const std::uint32_t count = e_.m;
    const Row* const solid = st_.solid[layers_.current].data();
    const Row* const hiding = st_.hiding[layers_.current].data();
    const Row* const solid_then = st_.solid[layers_.previous].data();
    const Row* const hiding_then = st_.hiding[layers_.previous].data();
    const Row* const cut_fast = st_.cut_fast[layers_.current].data();
    const Row* const cut_fast_then = st_.cut_fast[layers_.previous].data();
    const Row* const cut_mid = st_.cut_mid[layers_.current].data();
    const Row* const cut_mid_then = st_.cut_mid[layers_.previous].data();
    const Row* const cut_slow = st_.cut_slow.data();
    const auto face = [this](Side side, unsigned slot) { return st_.face[at(side)][slot].data(); };
    Row *const slow_neg = face(Side::slow_neg, 0), *const slow_pos = face(Side::slow_pos, 0);
    Row* const mid_neg = face(Side::mid_neg, layers_.current);
    Row* const mid_pos = face(Side::mid_pos, layers_.current);
    Row* const fast_neg = face(Side::fast_neg, layers_.current);
    Row* const fast_pos = face(Side::fast_pos, layers_.current);
    const Row* const mid_neg_then = face(Side::mid_neg, layers_.previous);
    const Row* const mid_pos_then = face(Side::mid_pos, layers_.previous);
    const Row* const fast_neg_then = face(Side::fast_neg, layers_.previous);
    const Row* const fast_pos_then = face(Side::fast_pos, layers_.previous);
    const Row hide_neg = builder_.hide_fast(Side::fast_neg, s, layers_.current);
    const Row hide_pos = builder_.hide_fast(Side::fast_pos, s, layers_.current);
    const Row last = Row{1} << (e_.f - 1);
    SideRows rows{};
    for (std::uint32_t m = 0; m < count; m += Lanes::kLanes) {
      const V voxels = Lanes::load(solid + m);
      const V hide = Lanes::load(hiding + m);
      V f_mid_neg = Lanes::without(voxels, Lanes::load(hiding + m - 1));
      V f_mid_pos = Lanes::without(voxels, Lanes::load(hiding + m + 1));
      V f_fast_neg = Lanes::without(
          voxels, Lanes::either(Lanes::up(hide), Lanes::where(low_lanes(hide_neg, m), Row{1})));
      V f_fast_pos = Lanes::without(
          voxels, Lanes::either(Lanes::down(hide), Lanes::where(low_lanes(hide_pos, m), last)));
      V f_slow_neg = Lanes::without(voxels, Lanes::load(hiding_then + m));
      V f_slow_pos = Lanes::without(Lanes::load(solid_then + m), hide);
      // The same faces of the previous row, for the slow sides.
      V g_slow_neg = Lanes::without(Lanes::load(solid + m - 1), Lanes::load(hiding_then + m - 1));
      V g_slow_pos = Lanes::without(Lanes::load(solid_then + m - 1), Lanes::load(hiding + m - 1));
      // `along`: bits at which strips along a row are cut differently than in the previous layer.
      // `between`: voxels whose material differs from that of the previous layer.
      V along = voxels, between = voxels, along_neg = voxels, along_pos = voxels;
      if constexpr (kManyMaterials) {
        const V fast = Lanes::load(cut_fast + m);
        const V mid = Lanes::load(cut_mid + m);
        between = Lanes::load(cut_slow + m);
        const V slow_before = Lanes::load(cut_slow + m - 1);
        const V fast_then = Lanes::load(cut_fast_then + m);
        const V mid_then = Lanes::load(cut_mid_then + m);
        f_mid_neg = Lanes::both(f_mid_neg, mid);
        f_mid_pos = Lanes::both(f_mid_pos, Lanes::load(cut_mid + m + 1));
        f_fast_neg = Lanes::both(f_fast_neg, fast);
        f_fast_pos = Lanes::both(f_fast_pos, Lanes::either(Lanes::down(fast), Lanes::all(last)));
        f_slow_neg = Lanes::both(f_slow_neg, between);
        f_slow_pos = Lanes::both(f_slow_pos, between);
        g_slow_neg = Lanes::both(g_slow_neg, slow_before);
        g_slow_pos = Lanes::both(g_slow_pos, slow_before);
        along = Lanes::either(between, Lanes::differing(fast, fast_then));
        along_neg = Lanes::either(mid, Lanes::differing(fast, Lanes::load(cut_fast + m - 1)));
        along_pos = Lanes::either(mid_then,
                                  Lanes::differing(fast_then, Lanes::load(cut_fast_then + m - 1)));
      }
      Lanes::store(f_slow_neg, slow_neg + m);
      Lanes::store(f_slow_pos, slow_pos + m);
      Lanes::store(f_mid_neg, mid_neg + m);
      Lanes::store(f_mid_pos, mid_pos + m);
      Lanes::store(f_fast_neg, fast_neg + m);
      Lanes::store(f_fast_pos, fast_pos + m);
      add(rows[at(Side::slow_neg)], differ(f_slow_neg, g_slow_neg, along_neg), m);
      add(rows[at(Side::slow_pos)], differ(f_slow_pos, g_slow_pos, along_pos), m);
      add(rows[at(Side::mid_neg)], differ(f_mid_neg, Lanes::load(mid_neg_then + m), along), m);
      add(rows[at(Side::mid_pos)], differ(f_mid_pos, Lanes::load(mid_pos_then + m), along), m);
      add(rows[at(Side::fast_neg)], differ(f_fast_neg, Lanes::load(fast_neg_then + m), between), m);
      add(rows[at(Side::fast_pos)], differ(f_fast_pos, Lanes::load(fast_pos_then + m), between), m);
    }
    // Rows behind the last row of the layer have no faces. The first of them would close open
    // strips.
    for (RowSet& set : rows) set &= bits_below<Row>(count);
    if (!is_whole_) keep_traced(rows);
    return rows;
  }

  /// Removes the rows and the faces that the part does not trace.
  void keep_traced(SideRows& rows) {
    for (const Side side : {Side::mid_neg, Side::mid_pos}) rows[at(side)] &= part_.traced[at(side)];
    for (const Side side : {Side::fast_neg, Side::fast_pos}) {
      Row* const face = st_.face[at(side)][layers_.current].data();
      const Row* const face_then = st_.face[at(side)][layers_.previous].data();
      const V traced = Lanes::all(part_.traced[at(side)]);
      RowSet with_faces = 0;
      for_rows<Lanes>(e_.m, [&](std::uint32_t m) {
        const V kept = Lanes::both(Lanes::load(face + m), traced);
        Lanes::store(kept, face + m);
        add(with_faces, Lanes::any(Lanes::either(kept, Lanes::load(face_then + m))), m);
      });
      rows[at(side)] &= with_faces;
    }
  }

  static HWY_INLINE std::uint64_t low_lanes(Row set, std::uint32_t m) {
    return static_cast<std::uint64_t>(set >> m);
  }
  /// Returns the lanes in which the faces differ from the previous ones or are cut differently.
  static HWY_INLINE std::uint64_t differ(V now, V before, [[maybe_unused]] V cut) {
    V x = Lanes::differing(now, before);
    if constexpr (kManyMaterials) x = Lanes::either(x, Lanes::both(now, cut));
    return Lanes::any(x);
  }
  static HWY_INLINE void add(RowSet& set, std::uint64_t lanes, std::uint32_t m) {
    set |= static_cast<Row>(lanes) << m;
  }

  /// Ends the sweep as if a layer without faces followed the last one, which is in the previous
  /// slot.
  SideRows end_faces() {
    builder_.hide_slow(Side::slow_pos, layers_.current, layers_.previous);
    Row* const slow_pos = st_.face[at(Side::slow_pos)][0].data();
    const Row* const solid = st_.solid[layers_.previous].data();
    const Row* const hiding = st_.hiding[layers_.current].data();
    for (std::uint32_t m = 0; m < e_.m; ++m) slow_pos[m] = solid[m] & ~hiding[m];
    SideRows rows{};
    for (std::uint32_t m = 0; m < e_.m; ++m) {
      rows[at(Side::slow_pos)] |= Row{slow_pos[m] != 0 || (m != 0 && slow_pos[m - 1] != 0)} << m;
    }
    for (const Side side : kLayerSides) {
      const Row* const before = st_.face[at(side)][layers_.previous].data();
      Row* const none = st_.face[at(side)][layers_.current].data();
      for (std::uint32_t m = 0; m < e_.m; ++m) {
        rows[at(side)] |= Row{before[m] != 0} << m;
        none[m] = 0;
      }
    }
    if (!is_whole_) keep_traced(rows);
    return rows;
  }

  /// Traces in the given rows the strips of layer s, or the strips that end behind the last layer.
  void trace(const SideRows& rows, std::uint32_t s) {
    if (s != e_.s)
      tracer_.template trace_slow<Side::slow_neg>(rows[at(Side::slow_neg)], s, layers_.current);
    if (s != 0)
      tracer_.template trace_slow<Side::slow_pos>(rows[at(Side::slow_pos)], s - 1,
                                                  layers_.previous);
    tracer_.template trace_middle<Side::mid_neg>(rows[at(Side::mid_neg)], s, layers_);
    tracer_.template trace_middle<Side::mid_pos>(rows[at(Side::mid_pos)], s, layers_);
    tracer_.template trace_fast<Side::fast_neg>(rows[at(Side::fast_neg)], s, layers_);
    tracer_.template trace_fast<Side::fast_pos>(rows[at(Side::fast_pos)], s, layers_);
  }

  SweepState<Row>& st_;
  const OrderedExtent e_;
  const SweepPart<Row> part_;
  const bool is_whole_;
  const bool wants_chunk_sides_;
  LayerPair layers_;
  LayerBuilder<Traits> builder_;
  ChunkSides<Traits> chunk_sides_;
  Tracer tracer_;
};

/// Sweeps the input with these lanes. Its chunk decides the rest of the SweepTraits.
template <class Lanes, class IndexLanes>
void sweep(const SweepInput& input, const Borders<typename Lanes::Row>& borders,
           const SweepPart<typename Lanes::Row>& part, SweepState<typename Lanes::Row>& state) {
  const OrderedExtent& e = input.extent;
  RUNSTONE_ASSERT(std::max({e.f, e.m, e.s}) <= kRowBits<typename Lanes::Row>);
  RUNSTONE_ASSERT(part.begin < part.end && part.end <= e.s);
  RUNSTONE_ASSERT(input.runs.size() != 0 &&
                  input.runs.end(input.runs.size() - 1) >= e.layer() * part.read_end(e));
  RUNSTONE_ASSERT(input.palette->solid_count() != 0);
  if (input.palette->solid_count() == 1) {
    Sweep<SweepTraits<Lanes, IndexLanes, BytePaletteIndex, false>>(input, borders, part, state)
        .run();
  } else if (input.palette->fit_bytes()) {
    Sweep<SweepTraits<Lanes, IndexLanes, BytePaletteIndex, true>>(input, borders, part, state)
        .run();
  } else {
    Sweep<SweepTraits<Lanes, IndexLanes, PaletteIndex, true>>(input, borders, part, state).run();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
