// Charts of horizontal bars: ranks, stacks and ranges.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/bench/report/chart/range_chart.hpp"
#include "tests/bench/report/chart/rank_chart.hpp"
#include "tests/bench/report/chart/stack_chart.hpp"
#include "tests/unit/bench/report/chart/svg_reader.hpp"

using namespace runstone::bench::chart;

namespace {

const Element& text_of(const SvgText& svg, const std::string& text) {
  for (const Element& element : svg.elements) {
    if (element.name == "text" && element.text == text) return element;
  }
  FAIL("no text " << text);
  return svg.elements.front();
}

double right_of(const Element& rect) { return rect.number("x") + rect.number("width"); }

}  // namespace

TEST_CASE("bars of a rank are as long as their values, with value and note behind", "[chart]") {
  const RankChart chart{{"ours", "theirs", "thesis", "none"},
                        {Role::ours, Role::other, Role::thesis, Role::other},
                        {11, 44, 22, NAN},
                        {"us"},
                        {"", "4 x"},
                        ""};
  const SvgText svg = read_svg(svg_of(chart));
  const Element ours = svg.with_class("c-ours").at(0);
  const Element theirs = svg.with_class("c-rest").at(0);
  CHECK(theirs.number("width") == Approx(4 * ours.number("width")).margin(0.3));
  CHECK(text_of(svg, "11").number("x") == Approx(right_of(ours) + 6).margin(0.2));
  CHECK(text_of(svg, "44").number("x") == Approx(right_of(theirs) + 6).margin(0.2));
  CHECK(text_of(svg, "4 x").number("x") > text_of(svg, "44").number("x") + 10);
  CHECK(text_of(svg, "ours").has_class("strong"));
  CHECK_FALSE(text_of(svg, "theirs").has_class("strong"));
  CHECK(svg.with_class("hatch").size() == 1);
  CHECK(svg.with_class("missing").size() == 1);
  CHECK(text_of(svg, "not measured").has_class("quiet"));
  CHECK(svg.has_text("theirs: 44 (4 x)"));
}

TEST_CASE("in a narrow picture names stand above their bars", "[chart]") {
  const RankChart chart{
      {"a rather long name of a mesher", "b"}, {}, {10, 40}, {"us"}, {"n", "m"}, ""};
  const SvgText narrow = read_svg(svg_of(chart, Width::narrow));
  const Element bar = narrow.with_class("c-rest").at(0);
  const Element& name = text_of(narrow, chart.names[0]);
  CHECK(name.number("y") < bar.number("y"));
  CHECK(name.number("x") == Approx(bar.number("x")).margin(0.2));
  CHECK(text_of(narrow, "n").number("y") == name.number("y"));
  CHECK(text_of(narrow, "b").number("y") - 9 > bar.number("y") + bar.number("height"));
  const SvgText wide = read_svg(svg_of(chart, Width::wide));
  CHECK(text_of(wide, chart.names[0]).number("x") < wide.with_class("c-rest").at(0).number("x"));
}

TEST_CASE("parts of a stack follow one another, and their sum stands behind", "[chart]") {
  const StackChart chart{{"flat", "hills", "caves"},
                         {{"sweep", Role::ours, {10, 20, NAN}},
                          {"merge", Role::other, {30, NAN, NAN}},
                          {"emit", Role::other, {5, 5}}},
                         {"us"},
                         ""};
  const SvgText svg = read_svg(svg_of(chart));
  const auto rects = svg.named("rect");
  REQUIRE(rects.size() == 3 + 5);  // swatches and parts
  const Element& sweep = rects[3];
  const Element& merge = rects[4];
  const Element& emit = rects[5];
  CHECK(merge.has_class("c-other0"));
  CHECK(emit.has_class("c-other1"));
  CHECK(merge.number("x") == Approx(right_of(sweep) + 1).margin(0.2));
  CHECK(emit.number("x") == Approx(right_of(merge) + 1).margin(0.2));
  CHECK(merge.number("width") + 1 == Approx(3 * (sweep.number("width") + 1)).margin(0.4));
  CHECK(text_of(svg, "45").number("x") > right_of(emit));
  CHECK(svg.has_text("25"));
  CHECK(svg.has_text("flat, merge: 30 of 45"));
  CHECK(svg.with_class("missing").size() == 1);  // caves
}

TEST_CASE("a range is a bar from low to high, a tick at the middle and a whisker to far",
          "[chart]") {
  const RangeChart chart{{"edit"}, {{10, 22, 40, 80}},           {Role::ours},
                         {"ms"},   {"p10", "p50", "p90", "p99"}, ""};
  const SvgText svg = read_svg(svg_of(chart));
  const auto rects = svg.named("rect");
  REQUIRE(rects.size() == 3);  // bar, the gap around the tick, the tick
  const double unit = rects[0].number("width") / 30;
  const double zero = rects[0].number("x") - 10 * unit;
  CHECK(rects[2].number("x") + 1.5 == Approx(zero + 22 * unit).margin(0.3));
  const auto whiskers = svg.with_class("whisker");
  REQUIRE(whiskers.size() == 2);
  CHECK(whiskers[0].number("x1") == Approx(right_of(rects[0])).margin(0.2));
  CHECK(whiskers[0].number("x2") == Approx(zero + 80 * unit).margin(0.5));
  CHECK(text_of(svg, "22").number("x") > whiskers[0].number("x2"));
  CHECK(svg.has_text("edit: p10 10, p50 22, p90 40, p99 80"));
  CHECK(svg.has_text("bar: p10 to p90; tick and number: p50; whisker: p99"));
}

TEST_CASE("a range shows its known values", "[chart]") {
  const auto drawn = [](const Range& range) {
    return read_svg(
        svg_of(RangeChart{{"a", "b"}, {range, {1, 2, 3, 4}}, {Role::ours}, {}, {}, ""}));
  };
  CHECK(drawn({NAN, 2, NAN, NAN}).with_class("c-ours").empty());
  CHECK(drawn({1, 2, 3, NAN}).with_class("c-ours").size() == 1);     // no whisker
  CHECK(drawn({NAN, 2, NAN, 4}).with_class("c-ours").size() == 2);   // line and end
  CHECK(drawn({1, NAN, 3, NAN}).with_class("missing").size() == 1);  // no number to write
  CHECK(drawn({3, 2, 1, NAN}).with_class("c-ours")[0].number("width") ==
        drawn({1, 2, 3, NAN}).with_class("c-ours")[0].number("width"));  // high below low
}
