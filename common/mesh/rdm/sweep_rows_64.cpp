#include "common/mesh/rdm/layer_sweep.hpp"

// The rest of this file is compiled once per instruction set. Highway selects one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/mesh/rdm/sweep_rows_64.cpp"
#include <hwy/foreach_target.h>
// Highway requires these includes after foreach_target.h.
#include <hwy/highway.h>

#include "common/mesh/rdm/layer_sweep-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

void sweep_64(const SweepInput& input, const Borders<Row64>& borders, const SweepPart<Row64>& part,
              SweepState<Row64>& state) {
  sweep<VectorRows<Row64>, VectorIndices>(input, borders, part, state);
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace runstone::rdm {

HWY_EXPORT(sweep_64);

void sweep_layers(const SweepInput& input, const Borders<Row64>& borders,
                  const SweepPart<Row64>& part, SweepState<Row64>& state) {
  HWY_DYNAMIC_DISPATCH(sweep_64)(input, borders, part, state);
}

}  // namespace runstone::rdm
#endif
