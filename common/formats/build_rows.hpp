// The cells of a build row by row, as many formats store them: x fastest, then z, then y.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "common/builds/build.hpp"

namespace runstone {

/// Takes the next `count` cells, which all have one cell number. Returns false to end the walk.
using BuildRowSink = std::function<bool(std::uint64_t count, std::uint16_t number)>;

/// Gives all cells of a build to the sink; neighbours in the walk differ. Returns false if the sink did.
/// Memory: the runs of 16 layers. Cost: O(rows of the sections + runs of a section * its layers / 16).
bool walk_build_rows(const Build& build, const BuildRowSink& sink);

/// Returns how many cells have each cell number, from 0 (untouched) on. Cost: O(sections + runs).
std::vector<std::uint64_t> count_cells(const Build& build);

}  // namespace runstone
