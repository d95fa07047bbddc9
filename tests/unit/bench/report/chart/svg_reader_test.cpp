// The XML reader of the other tests notices faults.
#include "tests/unit/bench/report/chart/svg_reader.hpp"

#include <catch2/catch.hpp>

using namespace runstone::bench::chart;

TEST_CASE("the reader takes an element, its attributes and its text", "[chart]") {
  const SvgText svg = read_svg(
      R"(<svg a="1 &lt; 2"><g class="x y"><title>b &amp; c</title><rect x="1.5"/></g></svg>)");
  REQUIRE(svg.error.empty());
  REQUIRE(svg.elements.size() == 4);
  CHECK(svg.elements[0].at("a") == "1 < 2");
  CHECK(svg.elements[1].has_class("y"));
  CHECK_FALSE(svg.elements[1].has_class("z"));
  CHECK(svg.elements[2].text == "b & c");
  CHECK(svg.elements[3].number("x") == 1.5);
  CHECK(svg.elements[3].depth == 2);
}

TEST_CASE("the reader refuses what is not well-formed", "[chart]") {
  for (const char* text : {"", "<a>", "<a></b>", "</a>", "<a/><b/>", "<a b=\"1\" b=\"2\"/>",
                           "<a b=1/>", "<a b/>", "<a>&</a>", "<a>&nbsp;</a>", "<a>></a>",
                           "<a b=\"<\"/>", "<a b=\"1/>", "<a ", "<>", "x", "<a>\x01</a>"}) {
    CAPTURE(text);
    CHECK_FALSE(read_svg(text).error.empty());
  }
}
