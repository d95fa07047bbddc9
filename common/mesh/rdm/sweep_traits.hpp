// SweepTraits: what the parts of a sweep are compiled for. Internal to rdm.
#pragma once

namespace runstone::rdm {

/// LanesOf: rows as many a step (row_lanes-inl.hpp). IndexLanesOf: codes side by side (index_lanes-inl.hpp).
/// ToIndex: the form of the codes. kManyMaterialsOf: the chunk has more than one material, so faces are cut where
/// it changes; with one, codes say no more than solid or not.
template <class LanesOf, class IndexLanesOf, class ToIndex, bool kManyMaterialsOf>
struct SweepTraits {
  using Lanes = LanesOf;
  using IndexLanes = IndexLanesOf;
  using Index = ToIndex;
  using Row = typename Lanes::Row;
  using Line = typename IndexLanes::template Line<Row, Index>;
  static constexpr bool kManyMaterials = kManyMaterialsOf;
};

}  // namespace runstone::rdm
