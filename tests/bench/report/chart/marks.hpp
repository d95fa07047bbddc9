// Marks: how a role looks as a bar, as a point, and where a value is missing.
#pragma once
#include <string_view>

#include "tests/bench/report/chart/role.hpp"
#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

/// Filled; hatched for the thesis. `colour` is the class of the colour. Hatching is drawn as lines, not as an SVG
/// pattern: patterns need names that are unique in a page, and vanish with the hidden one of two layouts.
void draw_bar(Svg& svg, const Box& box, Role role, std::string_view colour);

/// A large disc for ours, a square for the baseline, a ring for the thesis, a disc for others.
void draw_point(Svg& svg, double x, double y, double radius, Role role, std::string_view colour);

/// A small cross.
void draw_missing(Svg& svg, double x, double y);

}  // namespace runstone::bench::chart
