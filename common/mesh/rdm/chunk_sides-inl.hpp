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

 public:
  ChunkSides(const SweepInput& input, SweepState<Row>& state)
      : st_(state),
        e_(input.extent),
        mixed_(Traits::kManyMaterials && input.palette->has_transparent()) {}

  /// Adds the part of layer s, in slot `slot`, to the sides. Requires hiding rows that are its
  /// opaque ones.
  void find(std::uint32_t s, unsigned slot) {
    const Row* const opaque = st_.hiding[slot].data();
    auto& sides = st_.chunk_sides;
    sides[at(Side::mid_neg)][s] = opaque[0];
    sides[at(Side::mid_pos)][s] = opaque[e_.m - 1];
    sides[at(Side::fast_neg)][s] = first_column(opaque);
    sides[at(Side::fast_pos)][s] = last_column(opaque);
    if (s == 0) std::copy_n(opaque, e_.m, sides[at(Side::slow_neg)].data());
    if (s + 1 == e_.s) std::copy_n(opaque, e_.m, sides[at(Side::slow_pos)].data());
    if (s == 0) st_.sides_transparent.fill(false);
    if (!mixed_) return;
    const Row* const clear = st_.transparent.data();
    auto& found = st_.sides_transparent;
    found[at(Side::mid_neg)] |= clear[0] != 0;
    found[at(Side::mid_pos)] |= clear[e_.m - 1] != 0;
    found[at(Side::fast_neg)] |= first_column(clear) != 0;
    found[at(Side::fast_pos)] |= last_column(clear) != 0;
    const bool any = std::any_of(clear, clear + e_.m, [](Row row) { return row != 0; });
    if (s == 0) found[at(Side::slow_neg)] = any;
    if (s + 1 == e_.s) found[at(Side::slow_pos)] = any;
  }
  /// Does the same for a layer s that repeats the previous layer, which is in slot `slot`.
  void repeat(std::uint32_t s, unsigned slot) {
    auto& sides = st_.chunk_sides;
    for (const Side side : kLayerSides) sides[at(side)][s] = sides[at(side)][s - 1];
    if (s + 1 != e_.s) return;
    std::copy_n(st_.hiding[slot].data(), e_.m, sides[at(Side::slow_pos)].data());
    // The layer has one material: if any voxel is transparent, those of the first line are.
    st_.sides_transparent[at(Side::slow_pos)] = mixed_ && st_.transparent.data()[0] != 0;
  }

 private:
  Row first_column(const Row* rows) const { return column_of<Lanes, Row>(rows, e_.m, Row{1}); }
  Row last_column(const Row* rows) const {
    return column_of<Lanes, Row>(rows, e_.m, Row{1} << (e_.f - 1));
  }

  SweepState<Row>& st_;
  const OrderedExtent e_;
  const bool mixed_;  // some materials are transparent and others are not
};

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
