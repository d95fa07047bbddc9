// The cells of a build one after the other, as arrays of other formats have them. Internal to writers.
#pragma once
#include <cstdint>
#include <functional>

#include "common/builds/build.hpp"
#include "common/core/result.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// Calls f(count, cell number) for stretches of equal cells, in the order of the axes; neighbouring
/// stretches may be equal, and none is longer than 128 cells. Stops at the first failure of f, and
/// returns it. Cost: O(lines of 128 cells + runs). Memory: the runs of 64 layers.
Result<void> walk_cells(const Build& build, AxisOrder order,
                        const std::function<Result<void>(std::uint32_t, std::uint16_t)>& f);

}  // namespace runstone
