// RangeChart: for each name a bar from low to high, a tick at the middle and a thin whisker to far.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench::chart {

/// Missing values are NaN. Without `far` there is no whisker, without `low` or `high` no bar.
struct Range {
  double low = std::numeric_limits<double>::quiet_NaN();
  double middle = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  double far = std::numeric_limits<double>::quiet_NaN();
};

/// The names of the four values in the key and in tooltips. An empty one is left out.
struct RangeNames {
  std::string low = "lowest";
  std::string middle = "median";
  std::string high = "highest";
  std::string far = {};
};

struct RangeChart {
  std::vector<std::string> names = {};
  std::vector<Range> ranges = {};  // one a name
  std::vector<Role> roles = {};    // one a name; none: other
  Axis x = {};
  RangeNames value_names = {};
  std::string title = {};
};

/// See svg_of(BarChart). The middle is written behind each range.
std::string svg_of(const RangeChart& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
