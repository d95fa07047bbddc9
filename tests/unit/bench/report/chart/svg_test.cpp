// The elements of a chart are XML with valid numbers, whatever goes in.
#include "tests/bench/report/chart/svg.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/unit/bench/report/chart/svg_reader.hpp"

using namespace runstone::bench::chart;

TEST_CASE("numbers are short, and always numbers", "[chart]") {
  CHECK(number(12) == "12");
  CHECK(number(12.34) == "12.3");
  CHECK(number(-0.04) == "0");
  CHECK(number(NAN) == "0");
  CHECK(number(INFINITY) == "0");
}

TEST_CASE("a picture carries its label, its size and its marks", "[chart]") {
  Svg svg;
  svg.begin_mark("a \"b\" <c>");
  svg.rect({1, 2, -3, NAN}, "fill");
  svg.end_mark();
  svg.text(5, 6, Anchor::end, "x & y", "tick", -50);
  const SvgText read = read_svg(svg.finish(Width::wide, 99.2, "a \"b\" & <c>"));
  REQUIRE(read.error.empty());
  REQUIRE(read.elements.size() == 5);
  CHECK(read.elements[0].at("viewBox") == "0 0 720 100");
  CHECK(read.elements[0].at("aria-label") == "a \"b\" & <c>");
  CHECK(read.elements[2].text == "a \"b\" <c>");
  CHECK(read.elements[3].number("width") == 0);  // a negative width would be an error
  CHECK(read.elements[3].number("height") == 0);
  CHECK(read.elements[4].text == "x & y");
  CHECK(read.elements[4].has_class("end"));
  CHECK(read.elements[4].at("transform") == "rotate(-50 5 6)");
}

TEST_CASE("boxes overlap when they share an area", "[chart]") {
  CHECK(overlap({0, 0, 10, 10}, {9, 9, 10, 10}));
  CHECK_FALSE(overlap({0, 0, 10, 10}, {10, 0, 10, 10}));
  CHECK_FALSE(overlap({0, 0, 10, 10}, {0, 11, 10, 10}));
}
