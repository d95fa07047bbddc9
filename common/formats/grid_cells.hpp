// The cells of a build one after the other, as arrays of other formats have them. Internal to writers.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/result.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// Takes the next `count` cells, which all have one cell number. A failure ends the walk.
using CellSink = std::function<Result<void>(std::uint32_t count, std::uint16_t number)>;

/// Gives all cells of a build to the sink, in the order of the axes. A stretch has less than 65,664
/// cells, so the sink may expand it; neighbouring ones differ if the first has less than 65,536. Fails
/// with the error of the sink. Memory: the runs of 16 layers across the slowest axis. Cost: O(lines of
/// 128 cells + runs of a section * its layers / 16).
Result<void> walk_cells(const Build& build, AxisOrder order, const CellSink& sink);

/// Returns how many cells have each cell number, from 0 (untouched) on. Cost: O(sections + runs).
std::vector<std::uint64_t> count_cells(const Build& build);

}  // namespace runstone
