// Svg: the elements of one chart, written one after another. It decides only their syntax.
#pragma once
#include <string>
#include <string_view>

#include "tests/bench/report/chart/axis.hpp"

namespace runstone::bench::chart {

struct Box {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

bool overlap(const Box& a, const Box& b);

/// Returns the units from left to right.
double width_of(Width width);

/// Returns a length or position, to a tenth. A value that is not finite becomes 0, so that the
/// chart is never broken.
std::string number(double value);

enum class Anchor { start, middle, end };

/// CSS classes are names of this library, so they are written unchanged. All other text is escaped.
class Svg {
 public:
  /// Begins a mark with this tooltip. Everything up to end_mark() belongs to it.
  void begin_mark(std::string_view tooltip);
  void end_mark();
  void rect(const Box& box, std::string_view classes);
  void line(double x1, double y1, double x2, double y2, std::string_view classes);
  void path(std::string_view data, std::string_view classes);
  void circle(double x, double y, double radius, std::string_view classes);
  /// Draws text on the baseline `y`, turned about (x, y) by `degrees` clockwise.
  void text(double x, double y, Anchor anchor, std::string_view text, std::string_view classes,
            double degrees = 0);
  /// Returns the whole <svg>. `label` is its aria-label.
  [[nodiscard]] std::string finish(Width width, double height, std::string_view label) const;

 private:
  std::string body_;
};

/// Returns a chart that says why there is no other.
std::string note_svg(Width width, std::string_view note, std::string_view label);

}  // namespace runstone::bench::chart
