// RankChart: one horizontal bar a name, its value written at its end, in the given order.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench::chart {

struct RankChart {
  std::vector<std::string> names = {};
  std::vector<Role> roles = {};     // one a name; none: other
  std::vector<double> values = {};  // one a name; NaN: not measured
  Axis x = {};
  // One note for each name ("2.1 x ours"), in a quiet colour behind the value. May be empty.
  std::vector<std::string> notes = {};
  std::string title = {};
};

/// See svg_of(BarChart).
std::string svg_of(const RankChart& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
