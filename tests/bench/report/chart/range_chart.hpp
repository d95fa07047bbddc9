// RangeChart: per name a bar from low to high, a tick at the middle and a thin whisker to far.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench::chart {

/// Values that are not there are NaN: without `far` there is no whisker, without `low` or `high` no bar.
struct Range {
  double low = std::numeric_limits<double>::quiet_NaN();
  double middle = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  double far = std::numeric_limits<double>::quiet_NaN();
};

/// What the four values are called in the key and in tooltips; an empty one is not mentioned.
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

/// See svg_of(BarChart). Behind a range stands its middle.
std::string svg_of(const RangeChart& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
