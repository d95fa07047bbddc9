#include "client/report/report.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/runs/dense.hpp"

using namespace runstone;
using nlohmann::json;

namespace {

ClientReport sample() {
  ClientReport report;
  report.renderer = "none";
  auto& remote = report.latency.paths[static_cast<std::size_t>(EditPath::remote)];
  auto& meshed = remote.since_submit[static_cast<std::size_t>(LatencyStage::meshed)];
  for (int i = 0; i < 9; ++i) meshed.add(100);
  meshed.add_infinite();
  remote.edits = 10;
  report.meshes.jobs = 30;
  report.meshes.chunks = 20;
  for (int i = 0; i < 20; ++i) report.meshes.whole_ns.add(20'000);
  for (int i = 0; i < 10; ++i) report.meshes.layers_ns.add(5'000);
  report.meshes.kept_bytes = 3 << 19;
  return report;
}

}  // namespace

TEST_CASE("the report is JSON in which an infinite latency is the word inf", "[client_app]") {
  const ClientSession session(SessionConfig{});
  const json out = json::parse(to_json(sample(), session));
  const json& meshed = out["latency_us"]["remote"]["since_submit"]["meshed"];
  CHECK(meshed["count"] == 10);
  CHECK(meshed["infinite"] == 1);
  CHECK(meshed["p50"] == 100);
  CHECK(meshed["p90"] == 100);
  CHECK(meshed["p99"] == "inf");
  CHECK(meshed["max"] == "inf");
  CHECK(out["latency_us"]["remote"]["edits"] == 10);
  CHECK_FALSE(out["latency_us"]["remote"]["since_submit"].contains("presented"));
  CHECK(out["mesh"]["per_chunk"] == 1.5);
  CHECK(out["mesh"]["whole_ns"]["count"] == 20);
  CHECK(out["mesh"]["layers_ns"]["count"] == 10);
  CHECK(out["mesh"]["layers_ns"]["mean"] == 5000);
  CHECK(out["mesh"]["kept_bytes"] == 1'572'864);
  CHECK(out["clock"].is_null());
  CHECK(out["world_id"].is_null());
  CHECK(out["replica"]["drifted"] == 0);
}

TEST_CASE("the report says how often the memory budget bound, and what was in use",
          "[client_app]") {
  const ClientSession session(SessionConfig{});
  ClientReport report = sample();
  CHECK(to_table(report, session).find("budget") == std::string::npos);
  report.memory = {100, 20, 3, 4, 50};
  report.budget = {64 << 20, 1000, 3, 1, {2, 1}, {6, 3}};
  const json memory = json::parse(to_json(report, session))["memory"];
  CHECK(memory["budget_bytes"] == 64 << 20);
  CHECK(memory["peak_bytes"] == 1000);
  CHECK(memory["bytes"] == 177);
  CHECK(memory["gpu_bytes"] == 4);
  CHECK(memory["texture_bytes"] == 50);
  CHECK(memory["view_shrinks"] == 3);
  CHECK(memory["view_radius"] == 2);
  CHECK(memory["view_radius_wanted"] == 6);
  CHECK(to_table(report, session)
            .find("the budget of 64 MiB made the view shrink 3 times and grow "
                  "1 times; its radius is 2 of 6 chunks") != std::string::npos);
}

TEST_CASE("the report has the times at which parts of the first view were meshed", "[client_app]") {
  const ClientSession session(SessionConfig{});
  ClientReport report = sample();
  report.join.near = {203, 190, 12'500, 80'000, std::nullopt};
  const json near = json::parse(to_json(report, session))["join"]["near"];
  CHECK(near["chunks"] == 203);
  CHECK(near["meshed"] == 190);
  CHECK(near["first_ms"] == 12.5);
  CHECK(near["most_ms"] == 80);
  CHECK(near["all_ms"].is_null());
}

TEST_CASE("the report has the durations of frames, and so has the table of a client that draws",
          "[client_app]") {
  const ClientSession session(SessionConfig{});
  ClientReport report = sample();
  CHECK(json::parse(to_json(report, session))["frames"]["presented"] == 0);
  CHECK_THAT(to_table(report, session), !Catch::Contains("frames:"));
  report.frames.presented = 3;
  for (const int us : {200, 250, 90'000}) report.frames.draw_us.add(us);
  const json frames = json::parse(to_json(report, session))["frames"];
  CHECK(frames["presented"] == 3);
  CHECK(frames["draw_us"]["p50"] == 250);
  CHECK(frames["upload_us"]["count"] == 0);
  CHECK_THAT(to_table(report, session), Catch::Contains("frames: 3, each 0.25 ms (p50)\n"));
}

TEST_CASE("edits that this client refused are counted apart, and are in no percentile",
          "[client_app]") {
  const ClientSession session(SessionConfig{});
  ClientReport report = sample();
  CHECK(json::parse(to_json(report, session))["latency_us"]["local_refused"] == 0);
  CHECK_THAT(to_table(report, session), !Catch::Contains("refused"));
  report.edits_refused = 2;
  const json latency = json::parse(to_json(report, session))["latency_us"];
  CHECK(latency["local_refused"] == 2);
  CHECK(latency["local_confirmed"]["edits"] == 0);
  CHECK_THAT(to_table(report, session), Catch::Contains("edits refused by this client: 2\n"));
}

TEST_CASE("the table has chunks, drift and dense expansions on lines of their own",
          "[client_app]") {
  const ClientSession session(SessionConfig{});
  const std::string table = to_table(sample(), session);
  CHECK_THAT(table, Catch::Contains("meshes per chunk: 1.50 (30 of 20 chunks)\n"));
  CHECK_THAT(
      table,
      Catch::Contains("meshes of changed layers only: 10, each 5.0 us; 1.5 MiB of meshes kept\n"));
  CHECK_THAT(table,
             Catch::Contains("dense expansions: " + std::to_string(dense_expansions()) + "\n"));
  CHECK_THAT(table, Catch::Contains("drift: 0 of 0 digests checked\n"));
  CHECK_THAT(table, Catch::Matches("(.|\n)*remote +meshed +10 +0\\.10 +0\\.10 +inf +inf\n(.|\n)*"));
}
