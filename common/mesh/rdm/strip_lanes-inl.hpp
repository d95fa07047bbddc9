// Strip lanes: the functions of row_strips.hpp on vectors of rows. Highway includes this file once
// per instruction set, outside of any namespace.
#if defined(RUNSTONE_MESH_RDM_STRIP_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_MESH_RDM_STRIP_LANES_INL
#undef RUNSTONE_MESH_RDM_STRIP_LANES_INL
#else
#define RUNSTONE_MESH_RDM_STRIP_LANES_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

/// The faces of some rows, and the first and last of each strip. Traits: a SweepTraits.
template <class Traits>
struct StripLanes {
  using Lanes = typename Traits::Lanes;
  using Row = typename Traits::Row;
  using V = typename Lanes::V;
  V face, start, end;

  /// Returns the strips of rows, as strips_along() of one row. `face` and `cut` point to the first
  /// of the rows.
  static HWY_INLINE StripLanes along(const Row* face, [[maybe_unused]] const Row* cut) {
    const V f = Lanes::load(face);
    V before = Lanes::up(f);
    V behind = Lanes::down(f);
    if constexpr (Traits::kManyMaterials) {
      const V c = Lanes::load(cut);
      before = Lanes::without(before, c);
      behind = Lanes::without(behind, Lanes::down(c));
    }
    return {f, Lanes::without(f, before), Lanes::without(f, behind)};
  }
  /// Returns the changed bits of rows, as changed() of row_strips.hpp those of one row. `cut`
  /// points to the first of the rows.
  static HWY_INLINE V changed(const StripLanes& now, const StripLanes& before,
                              [[maybe_unused]] const Row* cut) {
    V x = Lanes::either(Lanes::differing(now.face, before.face),
                        Lanes::either(Lanes::differing(now.start, before.start),
                                      Lanes::differing(now.end, before.end)));
    if constexpr (Traits::kManyMaterials) {
      x = Lanes::either(x, Lanes::both(Lanes::both(now.face, before.face), Lanes::load(cut)));
    }
    return x;
  }
  /// Returns the ends of strips of rows, as ends_with() of row_strips.hpp those of one row.
  HWY_INLINE V ends_with(V x) const {
    x = Lanes::both(x, face);
    const V inner = Lanes::without(face, end);
    return Lanes::both(end, Lanes::either(x, Lanes::sum(inner, Lanes::both(x, inner))));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#endif
