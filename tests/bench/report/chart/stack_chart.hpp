// StackChart: one horizontal bar a name, made of parts, such as the parts of a time or a size.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/bar_chart.hpp"

namespace runstone::bench::chart {

struct StackChart {
  std::vector<std::string> names = {};
  std::vector<Series> parts = {};  // each with a value a name; negative ones are left out
  Axis x = {};                     // never logarithmic: lengths are added
  std::string title = {};
};

/// See svg_of(BarChart). The sum is written behind each bar.
std::string svg_of(const StackChart& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
