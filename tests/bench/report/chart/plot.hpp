// Plot: the area between two scales: grid lines, ticks and titles.
#pragma once
#include <string>

#include "tests/bench/report/chart/scale.hpp"
#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

/// The room that the ticks of a vertical scale need at its left.
double tick_room(const Scale& scale);

/// The ticks of a horizontal scale on the baseline `y`, kept within the picture; what would touch its left neighbour is
/// left out.
void draw_tick_row(Svg& svg, const Scale& scale, double y, double right);

/// Horizontal grid lines through `area`, their ticks at its left, and the caption above.
void draw_vertical_axis(Svg& svg, const Scale& scale, const std::string& caption, const Box& area);

/// Ticks and the caption below `area`. Needs kBelow units there. `right` is the end of the picture.
void draw_horizontal_axis(Svg& svg, const Scale& scale, const std::string& caption, const Box& area,
                          double right);

constexpr double kAbove = 26;  // units above an area, for the caption of its vertical scale
constexpr double kBelow = 42;

}  // namespace runstone::bench::chart
