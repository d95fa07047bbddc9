// Columns: as high as their values, side by side, in as many rows as they need.
#include "tests/bench/report/chart/bar_chart.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "tests/unit/bench/report/chart/svg_reader.hpp"

using namespace runstone::bench::chart;

namespace {

/// Returns the columns of one colour, in order. The first is the legend's swatch.
std::vector<Element> columns_of(const SvgText& svg, const std::string& colour) {
  std::vector<Element> out;
  for (const Element& element : svg.named("rect")) {
    if (element.has_class(colour)) out.push_back(element);
  }
  REQUIRE(!out.empty());
  out.erase(out.begin());
  return out;
}

}  // namespace

TEST_CASE("columns are as high as their values", "[chart]") {
  const BarChart chart{{"flat", "hills"},
                       {{"a", Role::ours, {10, 40}}, {"b", Role::baseline, {20, 80}}},
                       {"us"},
                       ""};
  const SvgText svg = read_svg(svg_of(chart));
  const auto ours = columns_of(svg, "c-ours");
  const auto baseline = columns_of(svg, "c-baseline");
  REQUIRE(ours.size() == 2);
  REQUIRE(baseline.size() == 2);
  CHECK(ours[1].number("height") == Approx(4 * ours[0].number("height")).margin(0.3));
  CHECK(baseline[1].number("height") == Approx(8 * ours[0].number("height")).margin(0.5));
  for (const auto& column : {ours[0], ours[1], baseline[0], baseline[1]}) {
    CHECK(column.number("y") + column.number("height") ==
          Approx(ours[0].number("y") + ours[0].number("height")).margin(0.2));
  }
  CHECK(ours[0].number("x") + ours[0].number("width") <= baseline[0].number("x"));
  CHECK(svg.has_text("a, hills: 40"));
  CHECK(svg.has_text("80"));  // there is room for it over its column
}

TEST_CASE("equal ratios are equal heights on a logarithmic scale", "[chart]") {
  const BarChart chart{{"x", "y", "z"}, {{"a", Role::ours, {10, 100, 1000}}}, {"us", true}, ""};
  const auto columns = columns_of(read_svg(svg_of(chart)), "c-ours");
  REQUIRE(columns.size() == 3);
  const auto height = [&](std::size_t i) { return columns[i].number("height"); };
  CHECK(height(2) - height(1) == Approx(height(1) - height(0)).margin(0.3));
  CHECK(height(0) > 2);
}

TEST_CASE("a missing value is a cross, and negative columns point down", "[chart]") {
  const SvgText svg =
      read_svg(svg_of(BarChart{{"x", "y", "z"}, {{"a", Role::ours, {5, NAN, -5}}}, {"us"}, ""}));
  CHECK(svg.with_class("missing").size() == 1);
  CHECK(svg.has_text("a, y: not measured"));
  const auto columns = columns_of(svg, "c-ours");
  REQUIRE(columns.size() == 2);
  CHECK(columns[0].number("y") + columns[0].number("height") ==
        Approx(columns[1].number("y")).margin(0.2));
  // The missing values of a short series were not measured.
  CHECK(read_svg(svg_of(BarChart{{"x", "y"}, {{"a", Role::ours, {5}}}, {}, ""}))
            .with_class("missing")
            .size() == 1);
}

TEST_CASE("many categories go into several rows", "[chart]") {
  BarChart chart{
      {}, {{"a", Role::ours, {}}, {"b", Role::thesis, {}}, {"c", Role::other, {}}}, {"us"}, ""};
  for (int i = 0; i < 45; ++i) {
    chart.categories.push_back("scenario " + std::to_string(i));
    for (Series& series : chart.series) series.values.push_back(50);
  }
  const auto rows_in = [&](Width width) {
    std::set<std::string> ends;
    const auto columns = columns_of(read_svg(svg_of(chart, width)), "c-ours");
    CHECK(columns.size() == 45);
    for (const Element& column : columns) {
      CHECK(column.number("width") >= 3.5);
      ends.insert(column.at("y"));
    }
    return ends.size();
  };
  CHECK(rows_in(Width::wide) == 2);
  CHECK(rows_in(Width::narrow) == 3);
}

TEST_CASE("the thesis' columns are hatched, so that they are recognised without colour",
          "[chart]") {
  const SvgText svg =
      read_svg(svg_of(BarChart{{"x"}, {{"t", Role::thesis, {5}}, {"a", Role::ours, {5}}}, {}, ""}));
  CHECK(svg.with_class("hatch").size() == 2);  // swatch and column
  for (const Element& hatch : svg.with_class("hatch")) CHECK(hatch.has_class("c-thesis"));
}
