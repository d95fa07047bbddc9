// Legend: a swatch and a name for each series, in as many lines as needed.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/role.hpp"
#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

struct LegendEntry {
  std::string name = {};
  Role role = Role::other;
  std::string colour = {};  // a CSS class
  bool is_line = false;     // form of the swatch
};

/// Returns the colours of series: all different as long as the palette has colours.
std::vector<std::string> colours_of(const std::vector<Role>& roles);

/// Draws a legend from `top` down. Returns the position at which the next element may begin.
double draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double right,
                   double top);

}  // namespace runstone::bench::chart
