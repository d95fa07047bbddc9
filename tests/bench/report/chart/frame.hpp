// A frame holds both layouts of one chart; the style sheet shows the one that fits the screen.
#pragma once
#include <string>

#include "tests/bench/report/chart/axis.hpp"

namespace runstone::bench::chart {

/// <div class="chart-frame"> with the wide and the narrow picture of a chart of any kind. This is what a page shows.
template <typename Chart>
std::string frame_of(const Chart& chart) {
  return "<div class=\"chart-frame\">" + svg_of(chart, Width::wide) + svg_of(chart, Width::narrow) +
         "</div>";
}

}  // namespace runstone::bench::chart
