#include "tests/bench/report/chart/range_chart.hpp"

#include <algorithm>
#include <cmath>

#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/marks.hpp"
#include "tests/bench/report/chart/rows.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kKeyHeight = 20;

std::string tooltip_of(const std::string& name, const Range& range, const RangeNames& names) {
  std::string out = name + ":";
  const auto add = [&](const std::string& what, double value) {
    if (!what.empty()) out += (out.ends_with(':') ? " " : ", ") + what + " " + format_value(value);
  };
  add(names.low, range.low);
  add(names.middle, range.middle);
  add(names.high, range.high);
  add(names.far, range.far);
  return out;
}

std::string key_of(const RangeNames& names) {
  std::string out;
  if (!names.low.empty() && !names.high.empty()) out += "bar: " + names.low + " to " + names.high;
  if (!names.middle.empty())
    out += (out.empty() ? "" : "; ") + std::string("tick and number: ") + names.middle;
  if (!names.far.empty()) out += (out.empty() ? "" : "; ") + std::string("whisker: ") + names.far;
  return out;
}

/// Draws a range. Returns the right end of what it drew.
double draw_range(Svg& svg, const Scale& scale, const Range& range, const Rows& rows,
                  std::size_t row, Role role) {
  const std::string colour = class_of(role);
  const double y = rows.bar_middle(row);
  double end = scale.base();
  const auto reach = [&](double value) {
    const double at = scale.place(value);
    end = std::max(end, at);
    return at;
  };
  if (scale.can_show(range.far)) {
    // The whisker begins at the highest value that is known.
    const double from = scale.can_show(range.high)     ? reach(range.high)
                        : scale.can_show(range.middle) ? reach(range.middle)
                                                       : reach(range.far);
    const double far = reach(range.far);
    svg.line(from, y, far, y, "whisker " + colour);
    svg.line(far, y - 4, far, y + 4, "whisker " + colour);
  }
  if (scale.can_show(range.low) && scale.can_show(range.high)) {
    const double a = reach(range.low);
    const double b = reach(range.high);
    draw_bar(svg, {std::min(a, b), y - 5, std::max(std::abs(b - a), 1.0), 10}, role, colour);
  }
  if (scale.can_show(range.middle)) {
    const double at = reach(range.middle);
    svg.rect({at - 2.5, y - 8, 5, 16}, "gap");  // so that the tick is wider than its bar
    svg.rect({at - 1.5, y - 8, 3, 16}, "ink");
  }
  return end;
}

}  // namespace

std::string svg_of(const RangeChart& chart, Width width) {
  const std::string label = chart.title.empty() ? "Ranges: " + chart.x.title : chart.title;
  const std::size_t count = chart.names.size();
  std::vector<Range> ranges = chart.ranges;
  ranges.resize(count);
  std::vector<double> all;
  double tail = 0;
  for (const Range& range : ranges) {
    all.insert(all.end(), {range.low, range.middle, range.high, range.far});
    tail = std::max(tail, width_of(format_value(range.middle), kTextSize) * kStrong + 10);
  }
  const bool is_narrow = width == Width::narrow;
  Scale scale(all, chart.x.is_log, chart.x.is_log ? Scale::Start::lowest : Scale::Start::bars,
              Scale::Ends::tight, is_narrow ? 5 : 7);
  if (!scale.has_values()) return note_svg(width, "Nothing was measured.", label);

  Svg svg;
  Rows rows(chart.names, chart.roles, tail, width);
  rows.begin_at(Rows::kAxisHeight + kKeyHeight);
  scale.lay(rows.left() + 5, rows.right());  // room for a whole tick at the lowest value
  svg.text(rows.left(), 14, Anchor::start,
           shortened(key_of(chart.value_names), kTickSize, rows.end() - rows.left()), "note");
  rows.draw_axis(svg, scale, caption_of(chart.x));
  for (std::size_t row = 0; row < count; ++row) {
    const Role role = row < chart.roles.size() ? chart.roles[row] : Role::other;
    const Range& range = ranges[row];
    const std::string text = format_value(range.middle);
    rows.draw_name(svg, row);
    svg.begin_mark(tooltip_of(chart.names[row], range, chart.value_names));
    double end = draw_range(svg, scale, range, rows, row, role);
    const bool is_there = scale.can_show(range.middle);
    if (!is_there) draw_missing(svg, end += 8, rows.bar_middle(row));
    svg.text(end + 7, rows.bar_middle(row) + 4, Anchor::start, text,
             !is_there            ? "quiet"
             : role == Role::ours ? "strong"
                                  : "plain");
    svg.end_mark();
  }
  return svg.finish(width, rows.bottom() + 2, label);
}

}  // namespace runstone::bench::chart
