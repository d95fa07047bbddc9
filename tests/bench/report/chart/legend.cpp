#include "tests/bench/report/chart/legend.hpp"

#include <map>

#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/marks.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kSwatch = 14;
constexpr double kSwatchGap = 6;
constexpr double kEntryGap = 18;
constexpr double kLine = 20;

}  // namespace

std::vector<std::string> colours_of(const std::vector<Role>& roles) {
  std::vector<std::string> out;
  out.reserve(roles.size());
  std::map<Role, std::size_t> counts;
  for (const Role role : roles) out.push_back(class_of(role, counts[role]++));
  return out;
}

double draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double right,
                   double top) {
  if (entries.empty()) return top;
  double x = left;
  double y = top;
  for (const LegendEntry& entry : entries) {
    const std::string name = shortened(entry.name, kTextSize, right - left - kSwatch - kSwatchGap);
    const double bold = entry.role == Role::ours ? kStrong : 1;
    const double width = kSwatch + kSwatchGap + width_of(name, kTextSize) * bold;
    if (x > left && x + width > right) {
      x = left;
      y += kLine;
    }
    if (entry.is_line) {
      const char* const stroke = entry.role == Role::thesis ? "line dashed " : "line ";
      svg.line(x, y + 8, x + kSwatch, y + 8, stroke + entry.colour);
    } else {
      draw_bar(svg, {x, y + 3, kSwatch, 10}, entry.role, entry.colour);
    }
    svg.text(x + kSwatch + kSwatchGap, y + 12, Anchor::start, name,
             entry.role == Role::ours ? "strong" : "plain");
    x += width + kEntryGap;
  }
  return y + kLine + 4;
}

}  // namespace runstone::bench::chart
