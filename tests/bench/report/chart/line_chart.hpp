// LineChart: lines over two scales, each named at its right end; with a legend where the names do not fit there.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench::chart {

struct Point {
  double x = 0;
  double y = 0;
};

struct LineSeries {
  std::string name = {};
  Role role = Role::other;
  std::vector<Point> points = {};  // in the order of the line; one that cannot be drawn breaks it
};

struct LineChart {
  Axis x = {};
  Axis y = {};
  std::vector<LineSeries> lines = {};
  std::string title = {};
};

/// See svg_of(BarChart).
std::string svg_of(const LineChart& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
