#include "tests/bench/report/chart/scatter_chart.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/label_placer.hpp"
#include "tests/bench/report/chart/marks.hpp"
#include "tests/bench/report/chart/plot.hpp"
#include "tests/bench/report/chart/scale.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kRadius = 4.5;
constexpr double kLabelHeight = 14;
constexpr double kInset = 16;

/// Returns the rank of a role for names. With little room the later ones have no name.
int label_rank(Role role) {
  switch (role) {
    case Role::ours:
      return 0;
    case Role::baseline:
      return 1;
    case Role::thesis:
      return 2;
    case Role::other:
      break;
  }
  return 3;
}

/// Draws an arrow to the lower left, above the right end of the chart, where no point lies.
void draw_better(Svg& svg, const Box& area) {
  const double x = area.x + area.width - 14;
  const double y = area.y - 12;
  svg.text(x - 6, y, Anchor::end, "better", "note");
  svg.path("M" + number(x + 14) + " " + number(y - 12) + "L" + number(x) + " " + number(y + 2) +
               "M" + number(x) + " " + number(y - 7) + "L" + number(x) + " " + number(y + 2) + "L" +
               number(x + 9) + " " + number(y + 2),
           "arrow");
}

void draw_label(Svg& svg, const ScatterPoint& point, double x, double y, const Box& box) {
  const LeadEnd lead = lead_to(box, x, y);
  constexpr double kClose = 12;
  if (lead.length > kClose) svg.line(x, y, lead.x, lead.y, "lead");
  svg.text(box.x, box.y + 11, Anchor::start, point.name,
           point.role == Role::ours ? "strong" : "plain");
}

struct PlacedPoint {
  const ScatterPoint* point = nullptr;
  double x = 0;
  double y = 0;
  std::optional<Box> label = {};
  std::uint32_t tie_break = 0;  // order among equals
};

/// Returns the units of leads; a point without room for its name counts as a very long lead.
double cost_of(const std::vector<PlacedPoint>& points) {
  double out = 0;
  for (const PlacedPoint& at : points) {
    if (at.point->is_labelled) out += at.label ? lead_to(*at.label, at.x, at.y).length : 500;
  }
  return out;
}

void place_labels(std::vector<PlacedPoint>& points, LabelPlacer placer) {
  for (PlacedPoint& at : points) {
    if (!at.point->is_labelled) continue;
    const double wide =
        width_of(at.point->name, kTextSize) * (at.point->role == Role::ours ? kStrong : 1.0);
    at.label = placer.place(at.x, at.y, kRadius + 1, wide, kLabelHeight);
  }
}

/// Earlier points find room more easily. Tries some orders, all sorted by role, and returns the
/// best result.
std::vector<PlacedPoint> with_labels(std::vector<PlacedPoint> points, const LabelPlacer& placer) {
  const auto is_before = [](const PlacedPoint& a, const PlacedPoint& b) {
    return std::tuple(label_rank(a.point->role), a.tie_break, a.point) <
           std::tuple(label_rank(b.point->role), b.tie_break, b.point);
  };
  std::vector<PlacedPoint> best;
  constexpr int kOrders = 16;
  std::uint32_t random = 0;
  for (int order = 0; order < kOrders; ++order) {
    std::sort(points.begin(), points.end(), is_before);  // the first attempt has the given order
    std::vector<PlacedPoint> tried = points;
    place_labels(tried, placer);
    if (best.empty() || cost_of(tried) < cost_of(best)) best = std::move(tried);
    for (PlacedPoint& at : points) {
      random = random * 1664525 + 1013904223;  // Numerical Recipes; the same chart every time
      at.tie_break = random >> 8;
    }
  }
  return best;
}

}  // namespace

std::string svg_of(const ScatterChart& chart, Width width) {
  const std::string label =
      chart.title.empty() ? "Points: " + chart.y.title + " over " + chart.x.title : chart.title;
  const bool is_narrow = width == Width::narrow;
  std::vector<std::size_t> shown;
  std::vector<double> xs;
  std::vector<double> ys;
  for (std::size_t i = 0; i < chart.points.size(); ++i) {
    const ScatterPoint& point = chart.points[i];
    if (!Scale::can_show(point.x, chart.x.is_log) || !Scale::can_show(point.y, chart.y.is_log))
      continue;
    shown.push_back(i);
    xs.push_back(point.x);
    ys.push_back(point.y);
  }
  Scale x_scale(xs, chart.x.is_log, Scale::Start::lowest, Scale::Ends::tight, is_narrow ? 5 : 8);
  Scale y_scale(ys, chart.y.is_log, Scale::Start::lowest, Scale::Ends::tight, 7);
  if (shown.empty()) return note_svg(width, "Nothing was measured.", label);

  const double left = tick_room(y_scale);
  const Box area{left, kAbove, width_of(width) - 18 - left, is_narrow ? 300.0 : 380.0};
  // The outermost points stay off the edges.
  x_scale.lay(area.x + kInset, area.x + area.width - kInset);
  y_scale.lay(area.y + area.height - 2 * kInset, area.y + kInset);

  Svg svg;
  draw_vertical_axis(svg, y_scale, caption_of(chart.y), area);
  draw_horizontal_axis(svg, x_scale, caption_of(chart.x), area, width_of(width));
  LabelPlacer placer({area.x + 2, area.y - 6, area.width + 14, area.height + 4});
  if (chart.is_low_better) draw_better(svg, area);
  std::vector<PlacedPoint> points;
  for (const std::size_t i : shown) {
    const ScatterPoint& point = chart.points[i];
    points.push_back({&point, x_scale.place(point.x), y_scale.place(point.y)});
    placer.block_point(points.back().x, points.back().y, kRadius + 1);
  }
  points = with_labels(std::move(points), placer);
  // Names are drawn first, so that points lie over their leads, and the product's points over all
  // others.
  for (const PlacedPoint& at : points) {
    if (at.label) draw_label(svg, *at.point, at.x, at.y, *at.label);
  }
  for (auto at = points.rbegin(); at != points.rend(); ++at) {
    const ScatterPoint& point = *at->point;
    svg.begin_mark(point.name + ": " + format_value(point.x) + ", " + format_value(point.y));
    draw_point(svg, at->x, at->y, kRadius, point.role, class_of(point.role));
    svg.end_mark();
  }
  return svg.finish(width, area.y + area.height + kBelow, label);
}

}  // namespace runstone::bench::chart
