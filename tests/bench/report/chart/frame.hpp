// A frame holds both layouts of one chart. The style sheet shows the one that fits the screen.
#pragma once
#include <string>

#include "tests/bench/report/chart/axis.hpp"

namespace runstone::bench::chart {

/// Returns a <div class="chart-frame"> with the wide and the narrow layout of a chart of any kind,
/// for a page.
template <typename Chart>
std::string frame_of(const Chart& chart) {
  return "<div class=\"chart-frame\">" + svg_of(chart, Width::wide) + svg_of(chart, Width::narrow) +
         "</div>";
}

}  // namespace runstone::bench::chart
