// ScatterChart: points over two scales, with names that do not overlap.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench::chart {

struct ScatterPoint {
  double x = 0;
  double y = 0;
  std::string name = {};
  Role role = Role::other;
  bool is_labelled = true;  // where there is room; otherwise the name is in the tooltip alone
};

struct ScatterChart {
  Axis x = {};
  Axis y = {};
  std::vector<ScatterPoint> points = {};
  bool is_low_better = false;  // an arrow says that the lower left is better
  std::string title = {};
};

/// See svg_of(BarChart). Cost: O(labelled points x points).
std::string svg_of(const ScatterChart& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
