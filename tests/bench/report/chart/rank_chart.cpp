#include "tests/bench/report/chart/rank_chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/marks.hpp"
#include "tests/bench/report/chart/rows.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kGap = 6;

template <typename T>
T at_or(const std::vector<T>& list, std::size_t at, T otherwise) {
  return at < list.size() ? list[at] : otherwise;
}

}  // namespace

std::string svg_of(const RankChart& chart, Width width) {
  const std::string label = chart.title.empty() ? "Bars: " + chart.x.title : chart.title;
  const std::size_t count = chart.names.size();
  std::vector<double> values = chart.values;
  values.resize(count, std::numeric_limits<double>::quiet_NaN());
  const bool is_narrow = width == Width::narrow;
  Scale scale(values, chart.x.is_log, Scale::Start::bars, Scale::Ends::tight, is_narrow ? 5 : 7);
  if (!scale.has_values()) return note_svg(width, "Nothing was measured.", label);

  double tail = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // The mark of a missing value begins where bars begin.
    if (!scale.can_show(values[i])) continue;
    const std::string note = is_narrow ? "" : at_or(chart.notes, i, std::string());
    const double room = width_of(format_value(values[i]), kTextSize) * kStrong + kGap +
                        (note.empty() ? 0 : width_of(note, kTickSize) + kGap);
    tail = std::max(tail, room);
  }
  Rows rows(chart.names, chart.roles, tail + kGap, width);
  rows.begin_at(Rows::kAxisHeight);
  scale.lay(rows.left(), rows.right());

  Svg svg;
  rows.draw_axis(svg, scale, caption_of(chart.x));
  for (std::size_t i = 0; i < count; ++i) {
    const Role role = at_or(chart.roles, i, Role::other);
    const std::string note = at_or(chart.notes, i, std::string());
    const std::string text = format_value(values[i]);
    const double y = rows.bar_middle(i);
    rows.draw_name(svg, i, note.empty() ? 0 : width_of(note, kTickSize) + kGap);
    svg.begin_mark(chart.names[i] + ": " + text + (note.empty() ? "" : " (" + note + ")"));
    double end = scale.base();
    if (scale.can_show(values[i])) {
      const double at = scale.place(values[i]);
      const double low = std::min(at, end);
      draw_bar(svg, {low, rows.bar_top(i), std::max(std::abs(at - end), 1.0), rows.bar_height()},
               role, class_of(role));
      end = std::max(at, end);
    } else {
      draw_missing(svg, end + kGap, y);
      end += 2 * kGap;
    }
    const bool is_there = scale.can_show(values[i]);
    svg.text(end + kGap, y + 4, Anchor::start, text,
             !is_there            ? "quiet"
             : role == Role::ours ? "strong"
                                  : "plain");
    if (is_narrow && !note.empty()) {
      svg.text(rows.end(), rows.bar_top(i) - 5, Anchor::end, note, "note");
    } else if (!note.empty()) {
      svg.text(end + 2 * kGap + width_of(text, kTextSize) * kStrong, y + 4, Anchor::start, note,
               "note");
    }
    svg.end_mark();
  }
  return svg.finish(width, rows.bottom() + 2, label);
}

}  // namespace runstone::bench::chart
