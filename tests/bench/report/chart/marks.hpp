// Marks: the look of a role as a bar and as a point, and the mark of a missing value.
#pragma once
#include <string_view>

#include "tests/bench/report/chart/role.hpp"
#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

/// Draws a filled bar, or a hatched one for the thesis. `colour` is a CSS class. Hatching is drawn
/// as lines, not as an SVG pattern: patterns need names that are unique in a page, and disappear
/// with the hidden one of two layouts.
void draw_bar(Svg& svg, const Box& box, Role role, std::string_view colour);

/// Draws a large disc for the product, a square for the baseline, a ring for the thesis, a disc for
/// others.
void draw_point(Svg& svg, double x, double y, double radius, Role role, std::string_view colour);

/// Draws a small cross.
void draw_missing(Svg& svg, double x, double y);

}  // namespace runstone::bench::chart
