// SweepTraits: the compile-time parameters of a sweep. Internal to rdm.
#pragma once

namespace runstone::rdm {

/// The parameters are:
///   - LanesOf: the rows of a step (row_lanes-inl.hpp);
///   - IndexLanesOf: the palette indices of a step (index_lanes-inl.hpp);
///   - IndexOf: the type of an index;
///   - kManyMaterialsOf: true if the chunk has more than one material, so that faces are cut where
///     the material changes. With one material, an index only says whether a voxel is solid.
template <class LanesOf, class IndexLanesOf, class IndexOf, bool kManyMaterialsOf>
struct SweepTraits {
  using Lanes = LanesOf;
  using IndexLanes = IndexLanesOf;
  using Index = IndexOf;
  using Row = typename Lanes::Row;
  using Line = typename IndexLanes::template Line<Row, Index>;
  static constexpr bool kManyMaterials = kManyMaterialsOf;
};

}  // namespace runstone::rdm
