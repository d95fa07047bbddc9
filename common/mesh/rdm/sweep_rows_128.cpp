#include "common/mesh/rdm/layer_sweep.hpp"

// The rest of this file is compiled once per instruction set. Highway selects one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/mesh/rdm/sweep_rows_128.cpp"
#include <hwy/foreach_target.h>
// Highway requires these includes after foreach_target.h.
#include <hwy/highway.h>

#include "common/mesh/rdm/layer_sweep-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

void sweep_128(const SweepInput& input, const Borders<Row128>& borders,
               const SweepPart<Row128>& part, SweepState<Row128>& state) {
  sweep<OneRow<Row128>, VectorIndices>(input, borders, part, state);
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace runstone::rdm {

HWY_EXPORT(sweep_128);

void sweep_layers(const SweepInput& input, const Borders<Row128>& borders,
                  const SweepPart<Row128>& part, SweepState<Row128>& state) {
  HWY_DYNAMIC_DISPATCH(sweep_128)(input, borders, part, state);
}

}  // namespace runstone::rdm
#endif
