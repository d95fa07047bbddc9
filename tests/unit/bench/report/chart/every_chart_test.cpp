// Rules for charts of every kind: any data gives a whole chart, with everything inside.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <sstream>

#include "tests/bench/report/chart/chart_css.hpp"
#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/frame.hpp"
#include "tests/bench/report/chart/legend.hpp"
#include "tests/bench/report/chart/svg.hpp"
#include "tests/unit/bench/report/chart/sample_charts.hpp"
#include "tests/unit/bench/report/chart/svg_reader.hpp"

using namespace runstone::bench::chart;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Width kWidths[] = {Width::wide, Width::narrow};

std::vector<std::string> plain_names(std::size_t count) {
  std::vector<std::string> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.push_back("mesher number " + std::to_string(i));
  return out;
}

/// Returns the box of an element; none for an element without a box of its own.
std::vector<Box> boxes_of(const Element& element) {
  const auto at = [&](const char* key) { return element.number(key); };
  if (element.name == "rect") return {{at("x"), at("y"), at("width"), at("height")}};
  if (element.name == "circle")
    return {{at("cx") - at("r"), at("cy") - at("r"), 2 * at("r"), 2 * at("r")}};
  if (element.name == "line") {
    return {{std::min(at("x1"), at("x2")), std::min(at("y1"), at("y2")),
             std::abs(at("x1") - at("x2")), std::abs(at("y1") - at("y2"))}};
  }
  if (element.name != "text") return {};
  const bool is_small = element.has_class("tick") || element.has_class("note");
  const double wide = width_of(element.text, is_small ? kTickSize : kTextSize);
  if (double degrees = 0;
      std::sscanf(element.at("transform").c_str(), "rotate(%lf", &degrees) == 1) {
    const double across = wide * std::cos(degrees / 180 * 3.14159265);
    const double down = wide * std::sin(degrees / 180 * 3.14159265);
    if (element.has_class("end")) return {{at("x") - across, at("y"), across, -down}};
    return {{at("x"), at("y") + down, across, -down}};
  }
  const double left = element.has_class("end") ? wide : element.has_class("mid") ? wide / 2 : 0;
  return {{at("x") - left, at("y") - 9, wide, 11}};
}

/// Returns the first fault of a chart, or an empty text.
std::string fault_of(const std::string& picture) {
  const SvgText svg = read_svg(picture);
  if (!svg.error.empty()) return svg.error;
  const Element& root = svg.elements.front();
  if (root.name != "svg" || root.at("role") != "img" || root.at("aria-label").empty())
    return "no picture for readers";
  double width = 0;
  double height = 0;
  if (std::sscanf(root.at("viewBox").c_str(), "0 0 %lf %lf", &width, &height) != 2)
    return "no viewBox";
  if (!root.at("width").empty() || !root.at("style").empty()) return "a size or a style of its own";
  for (const Element& element : svg.elements) {
    for (const auto& [key, value] : element.attributes) {
      if (key == "aria-label") continue;
      if (value.find("nan") != std::string::npos || value.find("inf") != std::string::npos)
        return key + "=" + value;
    }
    for (const Box& box : boxes_of(element)) {
      constexpr double kSlack = 0.2;  // rounding
      if (box.x < -kSlack || box.y < -kSlack || box.x + box.width > width + kSlack ||
          box.y + box.height > height + kSlack) {
        return element.name + " " + element.at("class") + " '" + element.text + "' outside";
      }
    }
  }
  return "";
}

}  // namespace

TEST_CASE("any data gives a well-formed picture with everything inside", "[chart][property]") {
  std::mt19937 random(Catch::rngSeed());
  const auto ordinary = [&] { return std::exp(static_cast<double>(random() % 800) / 100); };
  const auto awkward = [&]() -> double {
    constexpr double kAwkward[] = {0,    -1,     1e300,     -1e300,     1e-300, 1e16,
                                   1e30, 5e-324, kInfinity, -kInfinity, NAN,    3};
    return kAwkward[random() % std::size(kAwkward)];
  };
  const std::vector<std::function<double()>> kinds = {
      ordinary,
      awkward,
      [&] { return random() % 3 == 0 ? awkward() : ordinary(); },
      [] { return NAN; },
      [] { return 0.0; },
      [] { return 7.0; },
      [&] { return -ordinary(); }};
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{16}, std::size_t{37}}) {
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      for (const bool is_log : {false, true}) {
        for (const Width width : kWidths) {
          for (const auto& [name, svg] :
               sample_svgs({plain_names(count), kinds[kind], is_log}, width)) {
            CAPTURE(Catch::rngSeed(), count, kind, is_log, width == Width::wide, name);
            REQUIRE(fault_of(svg).empty());
          }
        }
      }
    }
  }
}

TEST_CASE("any name gives a well-formed picture with everything inside", "[chart]") {
  const std::vector<std::string> names = {
      "<script>alert('x')</script>",  "a & b \"c\"", "", "\xFF\xFE\x01", std::string(300, 'W'),
      "\xF0\x9F\x98\x80 \xE6\xBC\xA2"};
  for (const Width width : kWidths) {
    for (const auto& [name, svg] : sample_svgs({names, [] { return 2.5; }, false}, width)) {
      CAPTURE(name);
      CHECK(fault_of(svg).empty());
      CHECK(svg.find("<script") == std::string::npos);
      CHECK(svg.find("\xFF") == std::string::npos);
    }
  }
}

TEST_CASE("text does not overlap", "[chart][property]") {
  std::mt19937 random(Catch::rngSeed());
  for (const double decades : {0.1, 1.0, 3.0, 7.0}) {
    const auto value = [&] {
      return std::pow(10.0, decades * static_cast<double>(random() % 1000) / 1000) * 3;
    };
    for (const std::size_t count :
         {std::size_t{1}, std::size_t{5}, std::size_t{16}, std::size_t{37}}) {
      for (const bool is_log : {false, true}) {
        for (const Width width : kWidths) {
          for (const auto& [name, svg] : sample_svgs({plain_names(count), value, is_log}, width)) {
            std::vector<std::pair<std::string, Box>> texts;
            for (const Element& element : read_svg(svg).named("text")) {
              // slanted: their pitch keeps them apart
              if (!element.at("transform").empty()) continue;
              for (const Box& box : boxes_of(element)) texts.emplace_back(element.text, box);
            }
            for (std::size_t a = 0; a < texts.size(); ++a) {
              for (std::size_t b = 0; b < a; ++b) {
                if (!overlap(texts[a].second, texts[b].second)) continue;
                CAPTURE(Catch::rngSeed(), decades, count, is_log, width == Width::wide, name,
                        texts[a].first, texts[b].first);
                FAIL_CHECK("overlap");
              }
            }
          }
        }
      }
    }
  }
}

TEST_CASE("the fault finder of the chart tests finds planted faults", "[chart]") {
  const auto picture = [](const std::string& inside) {
    return R"(<svg viewBox="0 0 100 50" role="img" aria-label="x">)" + inside + "</svg>";
  };
  CHECK(fault_of(picture(R"(<rect x="1" y="1" width="9" height="9"/>)")).empty());
  CHECK_FALSE(fault_of(picture(R"(<rect x="95" y="1" width="9" height="9"/>)")).empty());
  CHECK_FALSE(fault_of(picture(R"(<rect x="1" y="1" width="9" height="nan"/>)")).empty());
  CHECK_FALSE(fault_of(picture(R"(<path d="M1 inf"/>)")).empty());
  CHECK_FALSE(fault_of(picture(R"(<text class="end" x="10" y="20">long text</text>)")).empty());
  CHECK_FALSE(fault_of(R"(<svg viewBox="0 0 100 50" role="img"/>)").empty());
  CHECK_FALSE(fault_of(R"(<svg viewBox="0 0 a" role="img" aria-label="x"/>)").empty());
}

TEST_CASE("a chart without values says so", "[chart]") {
  for (const Width width : kWidths) {
    for (const auto& [name, svg] : sample_svgs({plain_names(3), [] { return NAN; }, true}, width)) {
      CAPTURE(name);
      CHECK(read_svg(svg).has_text("Nothing was measured."));
    }
  }
}

TEST_CASE("every mark has a tooltip with its name", "[chart]") {
  for (const auto& [name, svg] :
       sample_svgs({plain_names(4), [] { return 2.5; }, false}, Width::wide)) {
    CAPTURE(name);
    const SvgText read = read_svg(svg);
    std::size_t tooltips = 0;
    for (const Element& title : read.named("title")) {
      CHECK(title.text.find("mesher number") != std::string::npos);
      CHECK(title.text.find("2.5") != std::string::npos);
      ++tooltips;
    }
    CHECK(tooltips == read.with_class("mark").size());
    CHECK(tooltips >= 4);
  }
}

TEST_CASE("the style sheet defines every class, and both themes every colour", "[chart]") {
  const std::string css = chart_css();
  for (const Width width : kWidths) {
    double value = 1;
    for (const auto& [name, svg] :
         sample_svgs({plain_names(16), [&] { return value *= 1.01; }, true}, width)) {
      for (const Element& element : read_svg(svg).elements) {
        std::istringstream classes(element.at("class"));
        for (std::string one; classes >> one;) {
          CAPTURE(name, one);
          const bool is_default = one == "plain" || one == "chart";
          if (!is_default) CHECK(css.find("." + one) != std::string::npos);
        }
      }
    }
  }
  std::vector<std::string> used;
  for (std::size_t at = css.find("var(--"); at != std::string::npos;
       at = css.find("var(--", at + 1)) {
    const std::size_t end = css.find_first_of(",)", at);
    used.push_back(css.substr(at + 4, end - at - 4));
  }
  REQUIRE(used.size() > 30);
  for (const std::string& property : used) {
    if (property == "--c") continue;  // set by the colour classes
    CAPTURE(property);
    std::size_t count = 0;
    for (std::size_t at = css.find(property + ":"); at != std::string::npos;
         at = css.find(property + ":", at + 1))
      ++count;
    CHECK(count == 3);  // light, dark by the system, dark by the page
  }
  CHECK(std::count(css.begin(), css.end(), '{') == std::count(css.begin(), css.end(), '}'));
}

TEST_CASE("no two series look alike, even of one role", "[chart]") {
  const std::vector<Role> roles = {Role::ours,     Role::other, Role::ours,
                                   Role::baseline, Role::other, Role::baseline};
  CHECK(colours_of(roles) == std::vector<std::string>{"c-ours", "c-other0", "c-ours2", "c-baseline",
                                                      "c-other1", "c-baseline2"});
}

TEST_CASE("a frame holds both layouts", "[chart]") {
  const SvgText frame = read_svg(frame_of(RankChart{{"a"}, {}, {1}, {}, {}, "rank"}));
  REQUIRE(frame.error.empty());
  const std::vector<Element> pictures = frame.named("svg");
  REQUIRE(pictures.size() == 2);
  CHECK(pictures[0].has_class("wide"));
  CHECK(pictures[1].has_class("narrow"));
  CHECK(frame.elements.front().has_class("chart-frame"));
}
