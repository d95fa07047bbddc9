// HeatMap: a table of values as colours from good to bad, with the value in each cell.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"
#include "tests/bench/report/chart/format_value.hpp"

namespace runstone::bench::chart {

struct HeatMap {
  std::vector<std::string> rows = {};
  std::vector<std::string> columns = {};
  std::vector<double> values = {};             // rows x columns, row by row; NaN: not measured
  Axis value = {.title = {}, .is_log = true};  // of the colours
  std::string (*text)(double) = format_value;  // of a cell; nullptr: no text
  bool is_low_good = true;
  std::string title = {};
};

/// See svg_of(BarChart).
std::string svg_of(const HeatMap& chart, Width width = Width::wide);

}  // namespace runstone::bench::chart
