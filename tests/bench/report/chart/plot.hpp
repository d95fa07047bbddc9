// Plot: the area between two scales: grid lines, ticks and titles.
#pragma once
#include <string>

#include "tests/bench/report/chart/scale.hpp"
#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

/// Returns the room that the ticks of a vertical scale need at its left.
double tick_room(const Scale& scale);

/// Draws the ticks of a horizontal scale on the baseline `y`, within the chart. Leaves out a tick
/// that would touch its left neighbour.
void draw_tick_row(Svg& svg, const Scale& scale, double y, double right);

/// Draws horizontal grid lines through `area`, their ticks at its left, and the caption above, with
/// `room` between caption and area.
void draw_vertical_axis(Svg& svg, const Scale& scale, const std::string& caption, const Box& area,
                        double room = 0);

/// Draws ticks and the caption below `area`, which needs kBelow units there. `right` is the end of
/// the chart.
void draw_horizontal_axis(Svg& svg, const Scale& scale, const std::string& caption, const Box& area,
                          double right);

constexpr double kAbove = 26;  // units above an area, for the caption of its vertical scale
constexpr double kBelow = 42;

}  // namespace runstone::bench::chart
