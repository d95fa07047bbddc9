// LineChart: lines over two scales. Each is named at its right end, or in a legend if the names do
// not fit there.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/role.hpp"
#include "tests/bench/report/chart/span.hpp"

namespace runstone::bench::chart {

struct Point {
  double x = 0;
  double y = 0;
};

struct LineSeries {
  std::string name = {};
  Role role = Role::other;
  // in the order of the line; a point that cannot be drawn interrupts it
  std::vector<Point> points = {};
};

struct LineChart {
  Axis x = {};
  Axis y = {};
  std::vector<LineSeries> lines = {};
  std::string title = {};
  std::vector<Span> spans = {};  // along x
  bool has_heading = false;      // the title is also written above the chart
};

/// See svg_of(BarChart).
std::string svg_of(const LineChart& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
