// The totals of each mesher over the thesis' 37 scenarios, the chunk in the middle of each.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/report/rows.hpp"

namespace runstone::bench {

/// A figure is NaN unless it is known for all 37: a sum of fewer would look smaller than it is.
struct MesherTotal {
  std::string mesher;
  double mean_ns = 0;  // geometric mean
  double sum_ns = 0;
  double triangles = 0, t_junctions = 0;  // sums
};

/// Returns the totals from the rows of the step "meshers", in their order.
std::vector<MesherTotal> mesher_totals(const Rows& rows);

/// Returns NaN in all figures if there is no such mesher.
MesherTotal total_of(const std::vector<MesherTotal>& totals, std::string_view mesher);

}  // namespace runstone::bench
