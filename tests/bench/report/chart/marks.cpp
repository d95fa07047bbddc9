#include "tests/bench/report/chart/marks.hpp"

#include <algorithm>
#include <string>

namespace runstone::bench::chart {
namespace {

/// Returns lines that rise to the right, cut at the box: all points with x + y = c, one step apart.
std::string hatching(const Box& box) {
  constexpr double kStep = 4.5;
  constexpr int kLinesMax = 1000;
  std::string out;
  double c = kStep;
  for (int i = 0; i < kLinesMax && c < box.width + box.height; ++i, c += kStep) {
    const double left = std::max(0.0, c - box.height);
    const double right = std::min(box.width, c);
    out += "M" + number(box.x + left) + " " + number(box.y + (c - left)) + "L" +
           number(box.x + right) + " " + number(box.y + (c - right));
  }
  return out;
}

std::string classes(std::string_view shape, std::string_view colour) {
  return std::string(shape) + " " + std::string(colour);
}

}  // namespace

void draw_bar(Svg& svg, const Box& box, Role role, std::string_view colour) {
  if (role != Role::thesis) return svg.rect(box, classes("fill", colour));
  // Half of the outline's width is inside the box.
  const Box inner{box.x + 0.5, box.y + 0.5, std::max(box.width - 1, 0.2),
                  std::max(box.height - 1, 0.2)};
  svg.rect(inner, classes("hollow", colour));
  const std::string lines = hatching(inner);
  if (!lines.empty()) svg.path(lines, classes("hatch", colour));
}

void draw_point(Svg& svg, double x, double y, double radius, Role role, std::string_view colour) {
  switch (role) {
    case Role::ours:
      return svg.circle(x, y, radius * 1.3, classes("fill halo", colour));
    case Role::baseline:
      return svg.rect({x - radius, y - radius, 2 * radius, 2 * radius},
                      classes("fill halo", colour));
    case Role::thesis:
      return svg.circle(x, y, radius, classes("hollow ring", colour));
    case Role::other:
      return svg.circle(x, y, radius, classes("fill halo", colour));
  }
}

void draw_missing(Svg& svg, double x, double y) {
  constexpr double kArm = 2.5;
  svg.path("M" + number(x - kArm) + " " + number(y - kArm) + "L" + number(x + kArm) + " " +
               number(y + kArm) + "M" + number(x - kArm) + " " + number(y + kArm) + "L" +
               number(x + kArm) + " " + number(y - kArm),
           "missing");
}

}  // namespace runstone::bench::chart
