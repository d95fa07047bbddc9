#include "tests/bench/report/chart/stack_chart.hpp"

#include <algorithm>
#include <limits>

#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/legend.hpp"
#include "tests/bench/report/chart/marks.hpp"
#include "tests/bench/report/chart/rows.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double part_of(const Series& part, std::size_t row) {
  const double value = row < part.values.size() ? part.values[row] : kNone;
  return Scale::can_show(value, false) && value >= 0 ? value : kNone;
}

/// Returns NaN if there is no part.
double sum_of(const std::vector<Series>& parts, std::size_t row) {
  double sum = kNone;
  for (const Series& part : parts) {
    const double value = part_of(part, row);
    if (value >= 0) sum = sum >= 0 ? sum + value : value;
  }
  return sum;
}

}  // namespace

std::string svg_of(const StackChart& chart, Width width) {
  const std::string label = chart.title.empty() ? "Stacked bars: " + chart.x.title : chart.title;
  std::vector<double> sums;
  double tail = 0;
  for (std::size_t row = 0; row < chart.names.size(); ++row) {
    sums.push_back(sum_of(chart.parts, row));
    tail = std::max(tail, width_of(format_value(sums[row]), kTextSize) + 8);
  }
  Scale scale(sums, false, Scale::Start::bars, Scale::Ends::tight, width == Width::narrow ? 5 : 7);
  if (!scale.has_values()) return note_svg(width, "Nothing was measured.", label);

  std::vector<Role> roles;
  roles.reserve(chart.parts.size());
  for (const Series& part : chart.parts) roles.push_back(part.role);
  const std::vector<std::string> colours = colours_of(roles);
  std::vector<LegendEntry> entries;
  entries.reserve(roles.size());
  for (std::size_t i = 0; i < chart.parts.size(); ++i) {
    entries.push_back({chart.parts[i].name, roles[i], colours[i]});
  }

  Svg svg;
  Rows rows(chart.names, {}, tail, width);
  rows.begin_at(draw_legend(svg, entries, rows.left(), rows.end(), 0) + Rows::kAxisHeight);
  scale.lay(rows.left(), rows.right());
  rows.draw_axis(svg, scale, chart.x.title);
  for (std::size_t row = 0; row < chart.names.size(); ++row) {
    rows.draw_name(svg, row);
    double end = 0;
    for (std::size_t i = 0; i < chart.parts.size(); ++i) {
      const double value = part_of(chart.parts[i], row);
      if (!(value > 0)) continue;
      const double from = scale.place(end);
      end += value;
      // A thin gap separates neighbours of similar colours.
      const double wide = scale.place(end) - from;
      svg.begin_mark(chart.names[row] + ", " + chart.parts[i].name + ": " + format_value(value) +
                     " of " + format_value(sums[row]));
      draw_bar(svg, {from, rows.bar_top(row), wide > 3 ? wide - 1 : wide, rows.bar_height()},
               roles[i], colours[i]);
      svg.end_mark();
    }
    const bool is_there = scale.can_show(sums[row]);
    const double x = scale.place(end) + 6;
    if (!is_there) draw_missing(svg, x, rows.bar_middle(row));
    svg.text(is_there ? x : x + 8, rows.bar_middle(row) + 4, Anchor::start, format_value(sums[row]),
             is_there ? "plain" : "quiet");
  }
  return svg.finish(width, rows.bottom() + 2, label);
}

}  // namespace runstone::bench::chart
