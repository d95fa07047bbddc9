// The page shows what was measured, and names what was not.
#include "tests/bench/report/page.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/bench/harness/machine.hpp"
#include "tests/bench/report/finding.hpp"
#include "tests/bench/report/step.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text_contains.hpp"

namespace runstone::bench {
namespace {

using test::contains;

ReportOptions options_of(const std::string& folder) {
  ReportOptions out;
  out.out = folder;
  out.thesis = RUNSTONE_SOURCE_DIR "/tests/data/thesis";
  return out;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

Finding edits_finding() {
  nlohmann::json rows = nlohmann::json::array();
  for (const double edits : {1.0, 10.0, 100.0, 1000.0}) {
    rows.push_back(
        {{"case", "mixed edits by hand as a stack"}, {"edits", edits}, {"median_us", edits / 4}});
    rows.push_back(
        {{"case", "mixed edits by hand one by one"}, {"edits", edits}, {"median_us", edits}});
  }
  return {"edits", this_machine(), true, "a world", "2026-01-31T23:59:59Z", 2, {{"rows", rows}}};
}

TEST_CASE("a page without findings says so in every figure and draws none") {
  const test::TempFolder folder;
  const auto made = write_page(options_of(folder / "out"), {});
  REQUIRE(made.has_value());
  CHECK(made->figures > 20);
  CHECK(made->missing == made->figures);
  const std::string page = text_of(made->file);
  CHECK(contains(page, "Nothing was measured yet."));
  CHECK(contains(page, "Not measured: edits."));
  CHECK_FALSE(contains(page, "<svg"));
  CHECK(std::filesystem::is_empty(folder / "out/csv"));
}

TEST_CASE("a figure shows its measurements and its data, and links to nothing on the web") {
  const test::TempFolder folder;
  REQUIRE(write_finding(folder / "out", edits_finding()).has_value());
  const auto made = write_page(options_of(folder / "out"), {{"bytes", "disk <full>"}});
  REQUIRE(made.has_value());
  CHECK(made->missing == made->figures - 1);
  const std::string page = text_of(made->file);
  CHECK(contains(page, "by hand take 250 µs as one stack and 1,000 µs one by one"));
  CHECK(contains(page, "<svg"));
  CHECK(contains(page, "bytes failed in this run: disk &lt;full&gt;."));
  CHECK_FALSE(contains(page, "nan"));
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http", "<script"}) {
    CHECK_FALSE(contains(page, outside));
  }
  const std::string csv = text_of(folder / "out/csv/stacks.csv");
  CHECK(contains(csv, "case,edits,median us,p90 us\r\n"));
  CHECK(contains(csv, "\"by hand, as a stack\",1000,250,\r\n"));
}

TEST_CASE("steps without measurements give no broken numbers") {
  const test::TempFolder folder;
  const ReportOptions options = options_of(folder / "out");
  for (const Step& step : report_steps(options)) {
    Finding finding = edits_finding();
    finding.step = step.name;
    finding.result = {{"rows", nlohmann::json::array()}, {"figures", nlohmann::json::array()}};
    REQUIRE(write_finding(folder / "out", finding).has_value());
  }
  const auto made = write_page(options, {});
  REQUIRE(made.has_value());
  CHECK(made->missing == 0);
  const std::string page = text_of(made->file);
  for (const char* broken : {"nan", "NaN", "inf\"", "-inf"}) CHECK_FALSE(contains(page, broken));
}

TEST_CASE("a result of another form counts as not measured") {
  const test::TempFolder folder;
  const ReportOptions options = options_of(folder / "out");
  const nlohmann::json shapes[] = {nullptr,
                                   3,
                                   "text",
                                   nlohmann::json::array({1, nullptr}),
                                   {{"rows", 3}},
                                   {{"rows", {{{"world", 3}, {"mesher", nullptr}}}}},
                                   {{"gl", 3}, {"width", "wide"}}};
  for (const nlohmann::json& shape : shapes) {
    for (const Step& step : report_steps(options)) {
      Finding finding = edits_finding();
      finding.step = step.name;
      finding.result = shape;
      REQUIRE(write_finding(folder / "out", finding).has_value());
    }
    const auto made = write_page(options, {});
    REQUIRE(made.has_value());
    const std::string page = text_of(made->file);
    CHECK(contains(page, "The meshers were not measured yet."));
    CHECK_FALSE(contains(page, "nan"));
  }
}

TEST_CASE(
    "frames are compared over the worlds that most meshers drew, and "
    "a mesher that drew fewer is named") {
  const test::TempFolder folder;
  Finding frames = edits_finding();
  frames.step = "frames";
  nlohmann::json rows = nlohmann::json::array();
  for (int world = 1; world <= 4; ++world) {
    const auto add = [&](const char* mesher, int vertices, double ms) {
      rows.push_back({{"world", "scenario_" + std::to_string(world)},
                      {"mesher", mesher},
                      {"path", "plain"},
                      {"vertices", vertices},
                      {"p50_ms", ms}});
    };
    add("none", 0, 0.1);
    add("culled", 400, 8);
    if (world != 4) add("rdm", 40, 2.0 * world);  // 2, 4, 6
    if (world == 1) add("simple", 4000, 80);
  }
  frames.result = {{"rows", rows},
                   {"gl", {{"renderer", "llvmpipe"}, {"software", true}}},
                   {"width", 640},
                   {"height", 360}};
  REQUIRE(write_finding(folder / "out", frames).has_value());
  const auto made = write_page(options_of(folder / "out"), {});
  REQUIRE(made.has_value());
  const std::string page = text_of(made->file);
  CHECK(contains(
      page,
      "A frame takes 3.63 ms (geometric mean of 3 worlds) with our mesh, 8 with culled faces"));
  CHECK(contains(page, "Too large to be drawn in most worlds, so not in the means: simple."));
  CHECK(contains(page, "Drawn by llvmpipe, 640 by 360 pixels."));
}

TEST_CASE("results of another commit are named at their figures") {
  const test::TempFolder folder;
  Finding other = edits_finding();
  REQUIRE(write_finding(folder / "out", other).has_value());
  for (const char* step : {"facts", "thesis"}) {
    other.step = step;
    other.machine.commit = "0123abc";
    REQUIRE(write_finding(folder / "out", other).has_value());
  }
  const auto made = write_page(options_of(folder / "out"), {});
  REQUIRE(made.has_value());
  CHECK(contains(text_of(made->file), "edits was measured on something else than the rest"));
}

TEST_CASE("the error of a page that cannot be written names the file") {
  const test::TempFolder folder;
  std::ofstream(folder / "out") << "a file where the folder should be";
  const auto made = write_page(options_of(folder / "out"), {});
  REQUIRE_FALSE(made.has_value());
  CHECK(contains(made.error(), folder / "out"));
}

}  // namespace
}  // namespace runstone::bench
