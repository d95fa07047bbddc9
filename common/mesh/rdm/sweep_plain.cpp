#include "common/mesh/rdm/layer_sweep.hpp"

// The rest of this file is compiled for AVX2 and for the baseline. The plain path uses no vectors,
// and more instruction sets would only add compile time. Highway selects one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/mesh/rdm/sweep_plain.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3)
#include <hwy/foreach_target.h>
// Highway requires these includes after foreach_target.h.
#include <hwy/highway.h>

#include "common/mesh/rdm/layer_sweep-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone::rdm {
namespace HWY_NAMESPACE {

void sweep_plain_64(const SweepInput& input, const Borders<Row64>& borders,
                    const SweepPart<Row64>& part, SweepState<Row64>& state) {
  sweep<OneRow<Row64>, PlainIndices>(input, borders, part, state);
}
void sweep_plain_128(const SweepInput& input, const Borders<Row128>& borders,
                     const SweepPart<Row128>& part, SweepState<Row128>& state) {
  sweep<OneRow<Row128>, PlainIndices>(input, borders, part, state);
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone::rdm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace runstone::rdm {

HWY_EXPORT(sweep_plain_64);
HWY_EXPORT(sweep_plain_128);

void sweep_layers_plain(const SweepInput& input, const Borders<Row64>& borders,
                        const SweepPart<Row64>& part, SweepState<Row64>& state) {
  HWY_DYNAMIC_DISPATCH(sweep_plain_64)(input, borders, part, state);
}
void sweep_layers_plain(const SweepInput& input, const Borders<Row128>& borders,
                        const SweepPart<Row128>& part, SweepState<Row128>& state) {
  HWY_DYNAMIC_DISPATCH(sweep_plain_128)(input, borders, part, state);
}

}  // namespace runstone::rdm
#endif
