#include "tests/bench/report/chart/heat_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tests/bench/report/chart/category_labels.hpp"
#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/marks.hpp"
#include "tests/bench/report/chart/scale.hpp"
#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {
namespace {

constexpr int kLevels = 9;  // as many as in chart_css()
constexpr double kCellHeight = 22;
constexpr double kCellWidest = 84;

/// Maps values to levels, 0 good to 8 bad.
struct Levels {
  bool is_log = true;
  bool is_low_good = true;
  double low = 0;
  double high = 0;

  [[nodiscard]] double at(double value) const { return is_log ? std::log(value) : value; }
  [[nodiscard]] int of(double value) const {
    const double range = at(high) - at(low);
    const double share = range > 0 ? (at(value) - at(low)) / range : 0.5;
    const double bad = is_low_good ? share : 1 - share;
    return std::clamp(static_cast<int>(bad * kLevels), 0, kLevels - 1);
  }
};

std::optional<Levels> levels_of(const HeatMap& chart) {
  std::optional<Levels> out;
  for (const double value : chart.values) {
    if (!Scale::can_show(value, chart.value.is_log)) continue;
    if (!out) out = Levels{chart.value.is_log, chart.is_low_good, value, value};
    out->low = std::min(out->low, value);
    out->high = std::max(out->high, value);
  }
  return out;
}

/// Draws the levels from good to bad, with the ends in numbers. Returns where the table may begin.
double draw_key(Svg& svg, const Levels& levels, const std::string& caption, Width width) {
  constexpr double kStep = 16;
  const double right = width_of(width) - 4;
  const std::string good = format_value(levels.is_low_good ? levels.low : levels.high);
  const std::string bad = format_value(levels.is_low_good ? levels.high : levels.low);
  const double bad_width = width_of(bad, kTickSize);
  const double strip = right - bad_width - 6 - kLevels * kStep;
  const double good_left = strip - 6 - width_of(good, kTickSize);
  const bool is_beside = good_left - 12 > width_of(caption, kTextSize);
  const double y = is_beside ? 2 : 22;
  svg.text(2, 14, Anchor::start, shortened(caption, kTextSize, right - 2), "quiet");
  svg.text(strip - 6, y + 12, Anchor::end, good, "tick");
  for (int level = 0; level < kLevels; ++level) {
    svg.rect({strip + level * kStep, y + 2, kStep, 12}, "fill heat" + std::to_string(level));
  }
  svg.text(right, y + 12, Anchor::end, bad, "tick");
  return y + 24;
}

void draw_cell(Svg& svg, const HeatMap& chart, const Levels& levels, std::size_t row,
               std::size_t column, const Box& box) {
  const std::size_t at = row * chart.columns.size() + column;
  const double value =
      at < chart.values.size() ? chart.values[at] : std::numeric_limits<double>::quiet_NaN();
  svg.begin_mark(chart.rows[row] + ", " + chart.columns[column] + ": " + format_value(value));
  if (Scale::can_show(value, chart.value.is_log)) {
    const std::string level = std::to_string(levels.of(value));
    svg.rect(box, "fill heat" + level);
    const std::string text = chart.text != nullptr ? chart.text(value) : "";
    if (!text.empty() && width_of(text, kTickSize) <= box.width) {
      svg.text(box.x + box.width / 2, box.y + box.height / 2 + 4, Anchor::middle, text,
               "tick on-heat" + level);
    }
  } else {
    svg.rect(box, "no-heat");
    draw_missing(svg, box.x + box.width / 2, box.y + box.height / 2);
  }
  svg.end_mark();
}

}  // namespace

std::string svg_of(const HeatMap& chart, Width width) {
  const std::string label =
      chart.title.empty() ? "Table in colours: " + chart.value.title : chart.title;
  const std::optional<Levels> levels = levels_of(chart);
  if (!levels || chart.rows.empty() || chart.columns.empty())
    return note_svg(width, "Nothing was measured.", label);

  double names = 0;
  for (const std::string& row : chart.rows) names = std::max(names, width_of(row, kTextSize));
  names = std::min(names, width_of(width) * 0.34);
  const double left = names + 12;
  // Leaves room at the right for the last slanted name.
  const double table = width_of(width) - left - (width == Width::wide ? 56 : 44);
  const double narrowest = width == Width::narrow ? 34 : 27;
  const std::vector<std::size_t> panels =
      panels_of(chart.columns.size(), static_cast<std::size_t>(table / narrowest));
  const double cell = std::min(table / static_cast<double>(panels.front()), kCellWidest);
  const CategoryLabels labels(chart.columns, cell);

  Svg svg;
  double y = draw_key(svg, *levels, caption_of(chart.value), width);
  std::size_t first = 0;
  for (const std::size_t count : panels) {
    y += labels.height();
    for (std::size_t i = 0; i < count; ++i) {
      labels.draw_above(svg, first + i, left + (static_cast<double>(i) + 0.5) * cell, y,
                        width_of(width));
    }
    for (std::size_t row = 0; row < chart.rows.size(); ++row, y += kCellHeight) {
      svg.text(names + 4, y + kCellHeight / 2 + 4, Anchor::end,
               shortened(chart.rows[row], kTextSize, names), "plain");
      for (std::size_t i = 0; i < count; ++i) {
        const Box box{left + static_cast<double>(i) * cell, y, cell - 1, kCellHeight - 1};
        draw_cell(svg, chart, *levels, row, first + i, box);
      }
    }
    first += count;
    y += 12;
  }
  return svg.finish(width, y, label);
}

}  // namespace runstone::bench::chart
