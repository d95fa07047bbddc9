#include "tests/bench/report/chart/span.hpp"

#include <algorithm>

#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/format_value.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kNarrowest = 8;  // a span with an upright name
constexpr double kLongestName = 110;
constexpr double kSpanNameGap = 4;  // below a name and above it

bool can_show(const Span& span, const Scale& scale) {
  return scale.can_show(span.from) && scale.can_show(span.to) && span.from <= span.to;
}

}  // namespace

double room_of(const std::vector<Span>& spans, const Scale& scale) {
  double longest = 0;
  for (const Span& span : spans) {
    if (!can_show(span, scale)) continue;
    if (scale.place(span.to) - scale.place(span.from) < kNarrowest) return 0;
    longest = std::max(longest, std::min(width_of(span.name, kTickSize), kLongestName));
  }
  return longest == 0 ? 0 : longest + 2 * kSpanNameGap;
}

void draw_spans(Svg& svg, const std::vector<Span>& spans, const Scale& scale, const Box& area,
                double room) {
  constexpr double kUp = -90;
  for (const Span& span : spans) {
    if (!can_show(span, scale)) continue;
    const double left = scale.place(span.from), width = scale.place(span.to) - left;
    svg.begin_mark(span.name + " from " + format_value(span.from) + " to " + format_value(span.to));
    svg.rect({left, area.y - room, width, area.height + room}, "shade");
    svg.end_mark();
    if (room == 0) continue;
    svg.text(left + width / 2 + kSpanNameGap, area.y - kSpanNameGap, Anchor::start,
             shortened(span.name, kTickSize, kLongestName), "note", kUp);
  }
}

}  // namespace runstone::bench::chart
