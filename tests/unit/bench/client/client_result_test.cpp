#include "bench/client/client_result.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

namespace runstone::bench {
namespace {

EffectsRow effects_row(const char* world, const char* mesher, const char* quality, double ms) {
  EffectsRow row;
  row.world = world;
  row.mesher = mesher;
  row.quality = quality;
  row.p50_ms = ms;
  return row;
}

}  // namespace

TEST_CASE("targets compare the worst world, and what is not measured is neither met nor missed",
          "[client_bench]") {
  ClientBenchResult result;
  result.bursts.resize(1);
  result.bursts[0].edits = 200;
  result.bursts[0].worst_added_ms = 7.5;
  result.bursts[0].slowest_ms = 42.5;
  result.bursts[0].still_slowest_ms = 30;
  result.own_edit = {10, 3, 2.1};
  result.effects = {effects_row("a", "rdm", "low", 10), effects_row("a", "rdm", "medium", 15),
                    effects_row("b", "rdm", "low", 10), effects_row("b", "rdm", "medium", 18)};
  const std::vector<Target> targets = result.targets();
  REQUIRE(targets.size() == 6);
  CHECK(targets[0].verdict == Verdict::met);
  CHECK(targets[0].measured == "7.5 ms");
  CHECK(targets[1].verdict == Verdict::missed);
  CHECK(targets[1].measured == "12.5 ms");
  CHECK(targets[2].verdict == Verdict::missed);
  CHECK(targets[3].verdict == Verdict::not_measured);
  CHECK(targets[4].verdict == Verdict::missed);
  CHECK(targets[4].measured == "1.80x");
  CHECK(targets[5].verdict == Verdict::not_measured);
}

TEST_CASE("the result is written as JSON and as tables", "[client_bench]") {
  ClientBenchResult result;
  result.bursts.resize(2);
  result.effects = {effects_row("a", "rdm", "low", 10)};
  std::ostringstream json, tables;
  write_json(result, json);
  write_tables(result, tables);
  const auto document = nlohmann::json::parse(json.str());
  CHECK(document.at("bursts").size() == 2);
  CHECK(document.at("effects").at(0).at("p50_ms") == 10);
  CHECK(tables.str().find("| a | rdm | low |") != std::string::npos);
}

}  // namespace runstone::bench
