// SweepTraits: what the parts of a sweep are compiled for. Internal to rdm.
#pragma once

namespace runstone::rdm {

/// LanesOf: rows as many a step (row_lanes-inl.hpp). CodeLanesOf: codes side by side (code_lanes-inl.hpp).
/// CodeOf: the form of the codes. kManyMaterials: the chunk has more than one material, so faces are cut where
/// it changes; with one, codes say no more than solid or not.
template <class LanesOf, class CodeLanesOf, class CodeOf, bool kManyMaterials>
struct SweepTraits {
  using Lanes = LanesOf;
  using CodeLanes = CodeLanesOf;
  using C = CodeOf;
  using Row = typename Lanes::Row;
  using Line = typename CodeLanes::template Line<Row, C>;
  static constexpr bool kNumbered = kManyMaterials;
};

}  // namespace runstone::rdm
