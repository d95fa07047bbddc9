// Charts over two scales, lines and points, and the heat map.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/heat_map.hpp"
#include "tests/bench/report/chart/line_chart.hpp"
#include "tests/bench/report/chart/scatter_chart.hpp"
#include "tests/bench/report/chart/svg.hpp"
#include "tests/bench/report/chart/svg_file.hpp"
#include "tests/unit/bench/report/chart/svg_reader.hpp"

using namespace runstone::bench::chart;

namespace {

/// Returns the names of marks: text that is neither tick nor note nor caption.
std::vector<Element> names_in(const SvgText& svg) {
  std::vector<Element> out;
  for (const Element& element : svg.named("text")) {
    if (element.has_class("plain") || element.has_class("strong")) out.push_back(element);
  }
  return out;
}

void check_apart(const std::vector<Element>& names) {
  const auto box = [](const Element& name) {
    return Box{name.number("x"), name.number("y") - 9, width_of(name.text, kTextSize), 11};
  };
  for (std::size_t a = 0; a < names.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      CAPTURE(names[a].text, names[b].text);
      CHECK_FALSE(overlap(box(names[a]), box(names[b])));
    }
  }
}

LineChart many_lines(std::size_t count, const std::string& name) {
  LineChart chart{{"voxels", true}, {"us", true}, {}, ""};
  for (std::size_t i = 0; i < count; ++i) {
    LineSeries line{name + std::to_string(i), i == 0 ? Role::ours : Role::other, {}};
    for (const double x : {1e3, 1e4, 1e5})
      line.points.push_back({x, x * (1 + 0.01 * static_cast<double>(i))});
    chart.lines.push_back(line);
  }
  return chart;
}

}  // namespace

TEST_CASE("a line goes through its points and breaks where there is none", "[chart]") {
  const LineChart chart{{"n", true},
                        {"us", true},
                        {{"a", Role::ours, {{1, 1}, {10, 10}, {100, NAN}, {1000, 1000}}}},
                        ""};
  const SvgText svg = read_svg(svg_of(chart));
  const auto lines = svg.with_class("strong-line");
  REQUIRE(lines.size() == 1);
  const std::string path = lines[0].at("d");
  CHECK(std::count(path.begin(), path.end(), 'M') == 2);
  CHECK(std::count(path.begin(), path.end(), 'L') == 1);
  const auto points = svg.named("circle");
  REQUIRE(points.size() == 3);
  const double dx = points[1].number("cx") - points[0].number("cx");
  const double dy = points[1].number("cy") - points[0].number("cy");
  CHECK(points[2].number("cx") - points[0].number("cx") == Approx(3 * dx).margin(0.3));
  CHECK(points[2].number("cy") - points[0].number("cy") == Approx(3 * dy).margin(0.3));
  CHECK(dy < 0);  // up
}

TEST_CASE("names stand at the ends of lines, apart, and in a legend where they do not fit",
          "[chart]") {
  const SvgText ends = read_svg(svg_of(many_lines(16, "mesher ")));
  const auto names = names_in(ends);
  REQUIRE(names.size() == 16);
  check_apart(names);
  CHECK(ends.with_class("lead").size() == 16);
  const SvgText legend = read_svg(svg_of(many_lines(40, "mesher ")));
  CHECK(names_in(legend).size() == 40);
  CHECK(legend.with_class("lead").empty());
  check_apart(names_in(legend));
  CHECK(read_svg(svg_of(many_lines(3, std::string(60, 'x')), Width::narrow))
            .with_class("lead")
            .empty());
}

TEST_CASE("spans are shaded behind a line, with upright names above the plot where they fit",
          "[chart]") {
  LineChart chart{{"s"}, {"ms"}, {{"a", Role::ours, {{0, 1}, {100, 2}}}}, "Title", {}, true};
  chart.spans = {{10, 20, "first"}, {30, 60, "second & last"}, {NAN, 80, "unknown"}};
  const SvgText svg = read_svg(svg_of(chart));
  REQUIRE(svg.error.empty());
  const auto shades = svg.with_class("shade");
  REQUIRE(shades.size() == 2);
  CHECK(shades[1].number("width") == Approx(3 * shades[0].number("width")).margin(0.3));
  CHECK(svg.has_text("Title"));
  CHECK(svg.has_text("first from 10 to 20"));
  std::vector<std::string> upright;
  for (const Element& text : svg.named("text")) {
    if (text.at("transform").empty()) continue;
    upright.push_back(text.text);
    CHECK(text.number("y") - width_of(text.text, kTickSize) > shades[0].number("y"));
  }
  CHECK(upright == std::vector<std::string>{"first", "second & last"});
  chart.spans.push_back({90, 90.1, "narrow"});
  for (const Element& text : read_svg(svg_of(chart)).named("text"))
    CHECK(text.at("transform").empty());
}

TEST_CASE("the file of a chart is the chart with its style sheet", "[chart]") {
  const LineChart chart{{"s"}, {"ms"}, {{"a", Role::ours, {{0, 1}, {9, 2}}}}, "a > b"};
  std::string text = svg_file_of(svg_of(chart));
  std::erase(text, '\n');  // the reader knows no lines
  const SvgText file = read_svg(text);
  REQUIRE(file.error.empty());
  REQUIRE(file.named("style").size() == 1);
  CHECK(file.named("style")[0].text.find("--paper") != std::string::npos);
  CHECK(file.elements.front().at("aria-label") == "a > b");
  CHECK(file.with_class("strong-line").size() == 1);
}

TEST_CASE("the thesis has dashed lines and hollow points", "[chart]") {
  const LineChart lines{
      {}, {}, {{"t", Role::thesis, {{1, 1}, {2, 2}}}, {"a", Role::ours, {{1, 2}}}}, ""};
  CHECK(read_svg(svg_of(lines)).with_class("dashed").size() == 1);
  const SvgText points = read_svg(svg_of(
      ScatterChart{{}, {}, {{1, 1, "t", Role::thesis}, {2, 2, "a", Role::ours}}, false, ""}));
  REQUIRE(points.with_class("hollow").size() == 1);
  CHECK(points.with_class("hollow")[0].has_class("c-thesis"));
}

TEST_CASE("names of points do not overlap, and the product's name is always shown",
          "[chart][property]") {
  std::mt19937 random(Catch::rngSeed());
  for (int round = 0; round < 30; ++round) {
    ScatterChart chart{{"us", true}, {"quads", true}, {}, true, ""};
    for (int i = 0; i < 16; ++i) {
      chart.points.push_back({std::exp(static_cast<double>(random() % 400) / 100),
                              std::exp(static_cast<double>(random() % 200) / 100),
                              "mesher " + std::to_string(i), i == 9 ? Role::ours : Role::other});
    }
    CAPTURE(Catch::rngSeed(), round);
    for (const Width width : {Width::wide, Width::narrow}) {
      const auto names = names_in(read_svg(svg_of(chart, width)));
      check_apart(names);
      CHECK(names.size() >= (width == Width::wide ? 14U : 6U));
      CHECK(std::count_if(names.begin(), names.end(),
                          [](const auto& name) { return name.text == "mesher 9"; }) == 1);
    }
  }
}

TEST_CASE("points lie at their values, and labels and the arrow to the good corner are optional",
          "[chart]") {
  ScatterChart chart{{"x"},
                     {"y"},
                     {{0, 0, "a", Role::ours}, {10, 10, "b", Role::baseline, false}, {5, NAN, "c"}},
                     false,
                     ""};
  const SvgText svg = read_svg(svg_of(chart));
  CHECK(svg.with_class("mark").size() == 2);
  const Element a = svg.with_class("c-ours").at(0);
  const Element b = svg.with_class("c-baseline").at(0);
  CHECK(a.number("cx") < b.number("x"));
  CHECK(a.number("cy") > b.number("y"));
  CHECK(names_in(svg).size() == 1);
  CHECK(svg.with_class("arrow").empty());
  chart.is_low_better = true;
  CHECK(read_svg(svg_of(chart)).with_class("arrow").size() == 1);
  CHECK(read_svg(svg_of(chart)).has_text("better"));
}

TEST_CASE("cells are coloured from good to bad by ratio, and show their values", "[chart]") {
  HeatMap chart{{"r"}, {"a", "b", "c", "d"}, {1, 10, 100, NAN}, {"us", true}};
  const auto marks = [&](const std::string& colour) {
    std::size_t out = 0;
    for (const Element& rect : read_svg(svg_of(chart)).named("rect"))
      out += rect.has_class(colour) && rect.number("height") > 13 ? 1 : 0;
    return out;
  };
  CHECK(marks("heat0") == 1);
  CHECK(marks("heat4") == 1);  // half way
  CHECK(marks("heat8") == 1);
  CHECK(marks("no-heat") == 1);
  CHECK(read_svg(svg_of(chart)).with_class("on-heat8").at(0).text == "100");
  CHECK(read_svg(svg_of(chart)).has_text("r, d: not measured"));
  chart.is_low_good = false;
  CHECK(read_svg(svg_of(chart)).with_class("on-heat0").at(0).text == "100");
  chart.value.is_log = false;
  CHECK(marks("heat8") == 2);  // 1 and 10 of 100
  chart.text = nullptr;
  CHECK(read_svg(svg_of(chart)).with_class("on-heat0").empty());
}

TEST_CASE("a heat map that is too wide continues below", "[chart]") {
  HeatMap chart{{"r", "s"}, {}, std::vector<double>(32, 2.0), {"us", true}};
  for (int i = 0; i < 16; ++i) chart.columns.push_back("column " + std::to_string(i));
  const auto rows_named = [&](Width width) {
    const auto names = names_in(read_svg(svg_of(chart, width)));
    return std::count_if(names.begin(), names.end(),
                         [](const auto& name) { return name.text == "r"; });
  };
  CHECK(rows_named(Width::wide) == 1);
  CHECK(rows_named(Width::narrow) == 2);
}
