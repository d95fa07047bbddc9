#include "tests/bench/report/chart/line_chart.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/label_placer.hpp"
#include "tests/bench/report/chart/legend.hpp"
#include "tests/bench/report/chart/marks.hpp"
#include "tests/bench/report/chart/plot.hpp"
#include "tests/bench/report/chart/scale.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kLabelPitch = 15;
constexpr double kLabelGap = 16;  // from the plot to its labels

struct Scales {
  Scale x, y;

  [[nodiscard]] bool can_show(const Point& point) const {
    return x.can_show(point.x) && y.can_show(point.y);
  }
};

/// Only points with both coordinates widen the scales.
Scales scales_of(const LineChart& chart, bool is_narrow) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (const LineSeries& line : chart.lines) {
    for (const Point& point : line.points) {
      if (!Scale::can_show(point.x, chart.x.is_log) || !Scale::can_show(point.y, chart.y.is_log))
        continue;
      xs.push_back(point.x);
      ys.push_back(point.y);
    }
  }
  return {Scale(xs, chart.x.is_log, Scale::Start::lowest, Scale::Ends::tight, is_narrow ? 5 : 8),
          Scale(ys, chart.y.is_log, chart.y.is_log ? Scale::Start::lowest : Scale::Start::bars,
                Scale::Ends::round, 7)};
}

void draw_line(Svg& svg, const LineSeries& line, const Scales& scales, const std::string& colour) {
  std::string path;
  bool is_broken = true;
  for (const Point& point : line.points) {
    if (!scales.can_show(point)) {
      is_broken = true;
      continue;
    }
    path += (is_broken ? "M" : "L") + number(scales.x.place(point.x)) + " " +
            number(scales.y.place(point.y));
    is_broken = false;
  }
  const char* const kind = line.role == Role::ours     ? "line strong-line "
                           : line.role == Role::thesis ? "line dashed "
                                                       : "line ";
  if (!path.empty()) svg.path(path, kind + colour);
  for (const Point& point : line.points) {
    if (!scales.can_show(point)) continue;
    svg.begin_mark(line.name + " at " + format_value(point.x) + ": " + format_value(point.y));
    draw_point(svg, scales.x.place(point.x), scales.y.place(point.y), 3, line.role, colour);
    svg.end_mark();
  }
}

std::optional<Point> end_of(const LineSeries& line, const Scales& scales) {
  for (auto point = line.points.rbegin(); point != line.points.rend(); ++point) {
    if (scales.can_show(*point)) return *point;
  }
  return std::nullopt;
}

/// Draws names at the ends of lines. A lead joins a name that had to move, or whose line ends
/// early.
void draw_end_labels(Svg& svg, const LineChart& chart, const Scales& scales,
                     const std::vector<std::string>& colours, const Box& area, double right) {
  std::vector<std::size_t> ended;
  std::vector<double> wanted;
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    if (const auto end = end_of(chart.lines[i], scales)) {
      ended.push_back(i);
      wanted.push_back(scales.y.place(end->y));
    }
  }
  const std::vector<double> placed = spread(wanted, kLabelPitch, area.y, area.y + area.height);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const LineSeries& line = chart.lines[ended[i]];
    const double from = scales.x.place(end_of(line, scales)->x) + 5;
    const double to = area.x + area.width + kLabelGap;
    const std::string bend = number(std::max(from, to - kLabelGap + 3));
    svg.path("M" + number(from) + " " + number(wanted[i]) + "L" + bend + " " + number(wanted[i]) +
                 "L" + number(to - 3) + " " + number(placed[i]),
             "lead " + colours[ended[i]]);
    svg.text(to, placed[i] + 4, Anchor::start, shortened(line.name, kTextSize, right - to),
             line.role == Role::ours ? "strong" : "plain");
  }
}

/// Draws the heading of a chart that has one. Returns where the next element may begin.
double draw_heading(Svg& svg, const LineChart& chart, double right) {
  if (!chart.has_heading) return 0;
  svg.text(2, 13, Anchor::start, shortened(chart.title, kTextSize, (right - 2) / kStrong),
           "strong");
  constexpr double kHeadingHeight = 24;
  return kHeadingHeight;
}

double draw_line_legend(Svg& svg, const LineChart& chart, const std::vector<std::string>& colours,
                        double right, double top) {
  std::vector<LegendEntry> entries;
  entries.reserve(chart.lines.size());
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    entries.push_back({chart.lines[i].name, chart.lines[i].role, colours[i], true});
  }
  return draw_legend(svg, entries, 2, right, top);
}

}  // namespace

std::string svg_of(const LineChart& chart, Width width) {
  const std::string label = chart.title.empty() ? "Lines: " + chart.y.title : chart.title;
  const bool is_narrow = width == Width::narrow;
  Scales scales = scales_of(chart, is_narrow);
  if (!scales.x.has_values()) return note_svg(width, "Nothing was measured.", label);

  std::vector<Role> roles;
  double widest = 0;
  for (const LineSeries& line : chart.lines) {
    roles.push_back(line.role);
    widest = std::max(widest,
                      width_of(line.name, kTextSize) * (line.role == Role::ours ? kStrong : 1.0));
  }
  const std::vector<std::string> colours = colours_of(roles);
  const double right = width_of(width) - 4;
  const double left = tick_room(scales.y);
  // Names at the ends take room from the lines. Colours need a legend, and repeat.
  const bool has_many = roles.size() > 8;
  const double height = has_many && is_narrow ? 280 : is_narrow ? 240 : 320;
  if (has_many) widest = std::min(widest, (right - left) * 0.4 - kLabelGap);
  const bool has_end_labels = widest + kLabelGap <= (right - left) * (has_many ? 0.4 : 0.35) &&
                              static_cast<double>(roles.size() - 1) * kLabelPitch <= height;

  Svg svg;
  double top = draw_heading(svg, chart, right);
  if (!has_end_labels) top = draw_line_legend(svg, chart, colours, right, top);
  const double end = has_end_labels ? right - widest - kLabelGap : right - 14;
  scales.x.lay(left, end);
  const double room = room_of(chart.spans, scales.x);
  const Box area{left, top + kAbove + room, end - left, height};
  scales.y.lay(area.y + height, area.y);
  draw_spans(svg, chart.spans, scales.x, area, room);
  draw_vertical_axis(svg, scales.y, caption_of(chart.y), area, room);
  draw_horizontal_axis(svg, scales.x, caption_of(chart.x), area, width_of(width));
  // The product is drawn last, so that it lies on top.
  for (const bool is_ours : {false, true}) {
    for (std::size_t i = 0; i < chart.lines.size(); ++i) {
      if ((roles[i] == Role::ours) == is_ours) draw_line(svg, chart.lines[i], scales, colours[i]);
    }
  }
  if (has_end_labels) draw_end_labels(svg, chart, scales, colours, area, right + 2);
  return svg.finish(width, area.y + height + kBelow, label);
}

}  // namespace runstone::bench::chart
