// Svg: the elements of one picture, written one after another. It decides nothing but how they are spelt.
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

/// Units from left to right.
double width_of(Width width);

/// A length or position, to a tenth; what is not finite becomes 0, since a picture must never be broken.
std::string number(double value);

enum class Anchor { start, middle, end };

/// Classes are words of this library and go in as they are; all other text is escaped.
class Svg {
 public:
  /// Everything up to end_mark() is one mark, with this tooltip.
  void begin_mark(std::string_view tooltip);
  void end_mark();
  void rect(const Box& box, std::string_view classes);
  void line(double x1, double y1, double x2, double y2, std::string_view classes);
  void path(std::string_view data, std::string_view classes);
  void circle(double x, double y, double radius, std::string_view classes);
  /// `y` is the baseline. Turned about (x, y) by `degrees` clockwise.
  void text(double x, double y, Anchor anchor, std::string_view text, std::string_view classes,
            double degrees = 0);
  /// The whole <svg>. `label` is its aria-label.
  [[nodiscard]] std::string finish(Width width, double height, std::string_view label) const;

 private:
  std::string body_;
};

/// A picture that says why there is none.
std::string note_svg(Width width, std::string_view note, std::string_view label);

}  // namespace runstone::bench::chart
