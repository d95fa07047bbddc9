#include "tests/bench/report/chart/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tests/bench/report/chart/chart_text.hpp"

namespace runstone::bench::chart {

bool overlap(const Box& a, const Box& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

double width_of(Width width) { return width == Width::wide ? 720 : 370; }

std::string number(double value) {
  if (!std::isfinite(value)) return "0";
  return fmt::format("{}", std::round(value * 10) / 10 + 0.0);  // + 0.0 turns "-0" into "0"
}

void Svg::begin_mark(std::string_view tooltip) {
  fmt::format_to(std::back_inserter(body_), "<g class=\"mark\"><title>{}</title>",
                 escaped(tooltip));
}

void Svg::end_mark() { body_ += "</g>"; }

void Svg::rect(const Box& box, std::string_view classes) {
  fmt::format_to(std::back_inserter(body_),
                 R"(<rect class="{}" x="{}" y="{}" width="{}" height="{}"/>)", classes,
                 number(box.x), number(box.y), number(std::max(box.width, 0.0)),
                 number(std::max(box.height, 0.0)));
}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view classes) {
  fmt::format_to(std::back_inserter(body_), R"(<line class="{}" x1="{}" y1="{}" x2="{}" y2="{}"/>)",
                 classes, number(x1), number(y1), number(x2), number(y2));
}

void Svg::path(std::string_view data, std::string_view classes) {
  fmt::format_to(std::back_inserter(body_), R"(<path class="{}" d="{}"/>)", classes, data);
}

void Svg::circle(double x, double y, double radius, std::string_view classes) {
  fmt::format_to(std::back_inserter(body_), R"(<circle class="{}" cx="{}" cy="{}" r="{}"/>)",
                 classes, number(x), number(y), number(std::max(radius, 0.0)));
}

void Svg::text(double x, double y, Anchor anchor, std::string_view text, std::string_view classes,
               double degrees) {
  const char* const side = anchor == Anchor::start    ? ""
                           : anchor == Anchor::middle ? " mid"
                                                      : " end";
  fmt::format_to(std::back_inserter(body_), R"(<text class="{}{}" x="{}" y="{}")", classes, side,
                 number(x), number(y));
  if (degrees != 0) {
    fmt::format_to(std::back_inserter(body_), " transform=\"rotate({} {} {})\"", number(degrees),
                   number(x), number(y));
  }
  fmt::format_to(std::back_inserter(body_), ">{}</text>", escaped(text));
}

std::string Svg::finish(Width width, double height, std::string_view label) const {
  return fmt::format(
      R"(<svg class="chart {}" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {} {}" role="img" aria-label="{}">{}</svg>)",
      width == Width::wide ? "wide" : "narrow", number(width_of(width)), number(std::ceil(height)),
      escaped(label), body_);
}

std::string note_svg(Width width, std::string_view note, std::string_view label) {
  Svg svg;
  svg.text(width_of(width) / 2, 34, Anchor::middle, note, "quiet");
  return svg.finish(width, 56, label);
}

}  // namespace runstone::bench::chart
