// Span: a part of a horizontal scale with a name, such as a time in which something happens. It is
// shaded behind the marks of a chart.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/scale.hpp"
#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

/// Spans of one chart do not overlap. They do not widen its scale.
struct Span {
  double from = 0;
  double to = 0;
  std::string name = {};
};

/// Returns the height above the plot that upright names of all spans need. Returns 0 if a span is
/// too narrow for its name, or if there are no spans. Then the names are only in the tooltips.
double room_of(const std::vector<Span>& spans, const Scale& scale);

/// Shades the spans over `area` and over the `room` above it, and writes the names there.
void draw_spans(Svg& svg, const std::vector<Span>& spans, const Scale& scale, const Box& area,
                double room);

}  // namespace runstone::bench::chart
