// A ranking: meshers by one figure, best first.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/rank_chart.hpp"

namespace runstone::bench {

struct Ranked {
  std::string mesher;
  double value = 0;
  std::string note = {};
};

/// Sorts the least first, equals by name, and missing values (NaN) last.
void rank(std::vector<Ranked>& all);

chart::RankChart chart_of(const std::vector<Ranked>& all, const chart::Axis& axis);

}  // namespace runstone::bench
