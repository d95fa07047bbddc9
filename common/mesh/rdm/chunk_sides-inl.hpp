// ChunkSides: collects the six outermost layers of the chunk itself during a sweep, for
// ChunkBorders. Highway includes this file once per instruction set, outside of any namespace.
#if defined(RUNSTONE_MESH_RDM_CHUNK_SIDES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_MESH_RDM_CHUNK_SIDES_INL
#undef RUNSTONE_MESH_RDM_CHUNK_SIDES_INL
#else
#define RUNSTONE_MESH_RDM_CHUNK_SIDES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
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
class ChunkSides {
  using Lanes = typename Traits::Lanes;
  using Row = typename Traits::Row;
  using Index = typename Traits::Index;

 public:
  ChunkSides(const SweepInput& input, SweepState<Row>& state)
      : st_(state),
        palette_(input.palette),
        e_(input.extent),
        mixed_(Traits::kManyMaterials && input.palette->has_transparent()),
        lists_materials_(mixed_ && input.palette->transparent_count() > 1) {
    for (ChunkSide<Row>& side : st_.chunk_sides) {
      side.has_transparent = false;
      side.materials.clear();
    }
  }

  /// Adds the part of layer s to the sides. `slot` is that of the layer, or of an earlier layer
  /// that it repeats. Requires hiding rows that are its opaque ones.
  void find(std::uint32_t s, unsigned slot) {
    const Row* const opaque = st_.hiding[slot].data();
    const std::uint32_t last = e_.m - 1;
    side(Side::mid_neg).opaque[s] = opaque[0];
    side(Side::mid_pos).opaque[s] = opaque[last];
    side(Side::fast_neg).opaque[s] = first_column(opaque);
    side(Side::fast_pos).opaque[s] = last_column(opaque);
    if (s == 0) std::copy_n(opaque, e_.m, side(Side::slow_neg).opaque.data());
    if (s + 1 == e_.s) std::copy_n(opaque, e_.m, side(Side::slow_pos).opaque.data());
    if (!mixed_) return;
    const Row* const clear = st_.transparent.data();
    const Index* const indices = st_.template indices<Index>()[slot].data();
    add(Side::mid_neg, s, clear[0], indices, 1);
    add(Side::mid_pos, s, clear[last], indices + last * e_.f, 1);
    add(Side::fast_neg, s, first_column(clear), indices, e_.f);
    add(Side::fast_pos, s, last_column(clear), indices + e_.f - 1, e_.f);
    for (std::uint32_t m = 0; m < e_.m; ++m) {
      if (s == 0) add(Side::slow_neg, m, clear[m], indices + m * e_.f, 1);
      if (s + 1 == e_.s) add(Side::slow_pos, m, clear[m], indices + m * e_.f, 1);
    }
  }

 private:
  Row first_column(const Row* rows) const { return column_of<Lanes, Row>(rows, e_.m, Row{1}); }
  Row last_column(const Row* rows) const {
    return column_of<Lanes, Row>(rows, e_.m, Row{1} << (e_.f - 1));
  }
  ChunkSide<Row>& side(Side side) { return st_.chunk_sides[at(side)]; }
  /// Sets a row of transparent voxels. The index of bit i is indices[i * step].
  void add(Side side, std::uint32_t row, Row clear, const Index* indices, std::uint32_t step) {
    ChunkSide<Row>& to = this->side(side);
    to.transparent[row] = clear;
    to.has_transparent |= clear != 0;
    if (!lists_materials_) return;
    for (; clear != 0; clear &= clear - 1)
      to.materials.push_back(palette_->material(indices[lowest_bit(clear) * step]));
  }

  SweepState<Row>& st_;
  const ChunkPalette* palette_;
  const OrderedExtent e_;
  const bool mixed_;            // some materials are transparent and others are not
  const bool lists_materials_;  // more than one is transparent
};

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
