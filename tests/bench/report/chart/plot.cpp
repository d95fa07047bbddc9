#include "tests/bench/report/chart/plot.hpp"

#include <algorithm>

#include "tests/bench/report/chart/chart_text.hpp"

namespace runstone::bench::chart {

double tick_room(const Scale& scale) {
  double widest = 0;
  for (const Tick& tick : scale.ticks()) widest = std::max(widest, width_of(tick.text, kTickSize));
  return widest + 12;
}

void draw_vertical_axis(Svg& svg, const Scale& scale, const std::string& caption, const Box& area,
                        double room) {
  svg.text(2, area.y - room - 14, Anchor::start,
           shortened(caption, kTextSize, area.x + area.width - 2), "quiet");
  for (const Tick& tick : scale.ticks()) {
    const double y = scale.place(tick.value);
    svg.text(area.x - 7, y + 4, Anchor::end, tick.text, "tick");
    svg.line(area.x, y, area.x + area.width, y, "grid");
  }
}

void draw_tick_row(Svg& svg, const Scale& scale, double y, double right) {
  double used = 0;
  for (const Tick& tick : scale.ticks()) {
    const double wide = width_of(tick.text, kTickSize);
    const double left =
        std::clamp(scale.place(tick.value) - wide / 2, 0.0, std::max(right - wide, 0.0));
    if (left < used) continue;
    svg.text(left + wide / 2, y, Anchor::middle, tick.text, "tick");
    used = left + wide + 6;
  }
}

void draw_horizontal_axis(Svg& svg, const Scale& scale, const std::string& caption, const Box& area,
                          double right) {
  const double bottom = area.y + area.height;
  for (const Tick& tick : scale.ticks()) {
    const double x = scale.place(tick.value);
    svg.line(x, area.y, x, bottom + 4, "grid");
  }
  draw_tick_row(svg, scale, bottom + 17, right);
  svg.text(area.x + area.width, bottom + 36, Anchor::end,
           shortened(caption, kTextSize, area.x + area.width), "quiet");
}

}  // namespace runstone::bench::chart
