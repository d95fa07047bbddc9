// BarChart: grouped columns, a group for each category. Many categories go into several rows of columns.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench::chart {

struct Series {
  std::string name = {};
  Role role = Role::other;
  std::vector<double> values =
      {};  // one a category (or a name, in a StackChart); NaN, or none: not measured
};

struct BarChart {
  std::vector<std::string> categories = {};
  std::vector<Series> series = {};
  Axis y = {};
  std::string title = {};  // what is shown, in words, for those who cannot see it
};

/// One <svg>. Any data gives a picture: what cannot be drawn is a small mark, and nothing at all is a note.
std::string svg_of(const BarChart& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
