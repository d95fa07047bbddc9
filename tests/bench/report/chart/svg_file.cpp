#include "tests/bench/report/chart/svg_file.hpp"

#include "tests/bench/report/chart/chart_css.hpp"

namespace runstone::bench::chart {

std::string svg_file_of(std::string svg) {
  // Attributes are escaped, so the first '>' ends the tag of <svg>. The style sheet contains no
  // character that XML forbids in text.
  svg.insert(svg.find('>') + 1,
             "<style>" + chart_css() + ".chart{background:var(--paper)}\n</style>");
  return svg + "\n";
}

}  // namespace runstone::bench::chart
