// BarChart: grouped columns, a group for each category. Many categories go into several rows of
// columns.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench::chart {

struct Series {
  std::string name = {};
  Role role = Role::other;
  // One value for each category (in a StackChart: for each name). NaN or missing: not measured.
  std::vector<double> values = {};
};

struct BarChart {
  std::vector<std::string> categories = {};
  std::vector<Series> series = {};
  Axis y = {};
  std::string title = {};  // the content in words, for readers who cannot see the chart
};

/// Returns one <svg>. Any data gives a chart: a value that cannot be drawn is a small mark, and a
/// chart without values is a note.
std::string svg_of(const BarChart& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
