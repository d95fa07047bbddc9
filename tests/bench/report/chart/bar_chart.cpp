#include "tests/bench/report/chart/bar_chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/bench/report/chart/category_labels.hpp"
#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/legend.hpp"
#include "tests/bench/report/chart/marks.hpp"
#include "tests/bench/report/chart/plot.hpp"
#include "tests/bench/report/chart/scale.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kThinnest = 4.5;  // the narrowest column
constexpr double kGroupGap = 5;
constexpr double kWidest = 34;

double value_of(const Series& series, std::size_t category) {
  return category < series.values.size() ? series.values[category]
                                         : std::numeric_limits<double>::quiet_NaN();
}

/// The widths of the categories right of `left`.
struct Columns {
  double left;
  std::vector<std::size_t> panels;
  double pitch = 0;

  Columns(const BarChart& chart, double left_end, Width width) : left(left_end) {
    const double room = width_of(width) - 4 - left;
    const double least =
        std::max(kSlantedPitch, static_cast<double>(chart.series.size()) * kThinnest + kGroupGap);
    panels = panels_of(chart.categories.size(), static_cast<std::size_t>(room / least));
    pitch = room / static_cast<double>(panels.front());
  }
};

/// One row of columns: categories [first, first + count) between the ends of `area`.
struct Panel {
  const BarChart& chart;
  const Scale& scale;
  const std::vector<std::string>& colours;
  Box area;
  double pitch;

  void draw(Svg& svg, std::size_t first, std::size_t count) const {
    const auto series = static_cast<double>(chart.series.size());
    const double gap = std::max(kGroupGap, pitch * 0.22);
    const double wide = std::min((pitch - gap) / series, kWidest);
    for (std::size_t i = 0; i < count; ++i) {
      const double middle = area.x + (static_cast<double>(i) + 0.5) * pitch;
      for (std::size_t s = 0; s < chart.series.size(); ++s) {
        draw_column(svg, first + i, s, middle + (static_cast<double>(s) - series / 2) * wide, wide);
      }
    }
    svg.line(area.x, scale.base(), area.x + area.width, scale.base(), "axis");
  }

  void draw_column(Svg& svg, std::size_t category, std::size_t s, double x, double wide) const {
    const Series& series = chart.series[s];
    const double value = value_of(series, category);
    const std::string text = format_value(value);
    svg.begin_mark(series.name + ", " + chart.categories[category] + ": " + text);
    if (scale.can_show(value)) {
      const double at = scale.place(value);
      const double top = std::min(at, scale.base());
      const double gap = wide > 6 ? 1 : 0.5;
      draw_bar(svg, {x, top, wide - gap, std::max(std::abs(scale.base() - at), 1.0)}, series.role,
               colours[s]);
      if (width_of(text, kTickSize) + 2 < wide) {
        const double y = at <= scale.base() ? top - 4 : at + 13;
        svg.text(x + (wide - gap) / 2, y, Anchor::middle, text, "tick");
      }
    } else {
      draw_missing(svg, x + wide / 2, scale.base() - 6);
    }
    svg.end_mark();
  }
};

}  // namespace

std::string svg_of(const BarChart& chart, Width width) {
  const std::string label = chart.title.empty() ? "Columns: " + chart.y.title : chart.title;
  std::vector<double> values;
  std::vector<Role> roles;
  for (const Series& series : chart.series) {
    roles.push_back(series.role);
    for (std::size_t i = 0; i < chart.categories.size(); ++i) values.push_back(value_of(series, i));
  }
  Scale scale(values, chart.y.is_log, Scale::Start::bars, Scale::Ends::round, 6);
  if (!scale.has_values()) return note_svg(width, "Nothing was measured.", label);

  const std::vector<std::string> colours = colours_of(roles);
  std::vector<LegendEntry> entries;
  entries.reserve(roles.size());
  for (std::size_t i = 0; i < roles.size(); ++i)
    entries.push_back({chart.series[i].name, roles[i], colours[i]});

  Columns columns(chart, tick_room(scale), width);
  const double overhang =
      CategoryLabels(chart.categories, columns.pitch).overhang(0) - columns.pitch / 2 + 2;
  constexpr double kOverhangMax = 80;
  if (overhang > columns.left) columns = Columns(chart, std::min(overhang, kOverhangMax), width);
  const auto& [left, panels, pitch] = columns;
  const CategoryLabels labels(chart.categories, pitch);
  const double height = panels.size() == 1 ? 230 : 180;

  Svg svg;
  double y = draw_legend(svg, entries, 2, width_of(width) - 4, 0);
  std::size_t first = 0;
  for (const std::size_t count : panels) {
    const Box area{left, y + (first == 0 ? kAbove : 10), pitch * static_cast<double>(count),
                   height};
    scale.lay(area.y + height, area.y);
    draw_vertical_axis(svg, scale, first == 0 ? caption_of(chart.y) : "", area);
    Panel{chart, scale, colours, area, pitch}.draw(svg, first, count);
    for (std::size_t i = 0; i < count; ++i) {
      labels.draw_below(svg, first + i, left + (static_cast<double>(i) + 0.5) * pitch,
                        area.y + height);
    }
    first += count;
    y = area.y + height + labels.height();
  }
  return svg.finish(width, y, label);
}

}  // namespace runstone::bench::chart
