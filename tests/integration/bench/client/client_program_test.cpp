// `runstone-bench client` as a program: its counts are right. No test checks times.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "client/platform/gl_context.hpp"
#include "tests/integration/bench/bench_output.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::bench;

TEST_CASE("runstone-bench client counts frames of bursts, own edits and effects",
          "[client_bench]") {
  try {
    make_headless_context();
  } catch (const std::runtime_error& error) {
    WARN(error.what());
    return;
  }
  const test::TempFolder folder;
  const std::string file = folder / "client.json";
  const BenchOutput output = run_bench({"client", "--edits", "30", "--bursts", "1", "--own-edits",
                                        "2", "--frames", "3", "--size", "64x36", "--json", file});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  std::ifstream in(file);
  const auto document = nlohmann::json::parse(in);
  REQUIRE(document.at("bursts").size() == 2);
  for (const auto& row : document.at("bursts")) {
    CHECK(row.at("edits") == 30);
    CHECK(row.at("frames_min") >= 1);
    CHECK(row.at("total_ms") > 0);
  }
  CHECK(document.at("bursts").at(1).at("carried_max") == 0);  // without a budget
  CHECK(document.at("own_edit").at("edits") == 2);
  CHECK(document.at("own_edit").at("frames_max") >= 1);
  CHECK(document.at("own_edit").at("frames_max") < 100);
  CHECK(document.at("effects").size() == 2 * 2 * 3);
  for (const auto& row : document.at("effects")) CHECK(row.at("quads_drawn") > 0);
  CHECK(output.out.find("own edit to changed pixels") != std::string::npos);
}
