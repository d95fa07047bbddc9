// Legend: a swatch and a name for each series, in as many lines as they take.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/role.hpp"
#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

struct LegendEntry {
  std::string name = {};
  Role role = Role::other;
  std::string colour = {};  // a class
  bool is_line = false;     // the swatch
};

/// The colours of series: no two alike while the palette lasts.
std::vector<std::string> colours_of(const std::vector<Role>& roles);

/// Draws from `top` down; returns where the next thing may begin.
double draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double right,
                   double top);

}  // namespace runstone::bench::chart
