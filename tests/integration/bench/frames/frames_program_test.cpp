// The benchmark as a program: its files contain what the command line names, and its counts are
// right. No test checks times.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "client/platform/gl_context.hpp"
#include "tests/integration/bench/bench_output.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::bench;

namespace {

BenchOutput run(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "frames");
  return run_bench(arguments);
}

/// Returns the bytes of indexed triangles.
std::size_t bytes_of(const nlohmann::json& row) {
  return 8 * row.at("vertices").get<std::size_t>() + 12 * row.at("triangles").get<std::size_t>();
}

bool has_context() {
  try {
    make_headless_context();
    return true;
  } catch (const std::runtime_error& error) {
    WARN(error.what());
    return false;
  }
}

}  // namespace

TEST_CASE("runstone-bench frames has a row for every mesher in every world", "[frames]") {
  if (!has_context()) return;
  const test::TempFolder folder;
  const std::string json = folder / "frames.json", csv = folder / "frames.csv";
  const BenchOutput output =
      run({"--worlds", "scenario_6,scenario_1,luanti", "--meshers",
           "rdm,rdm_plain,culled,rle_rdm,quads,product", "--frames", "4", "--pictures", "2",
           "--size", "160x90", "--csv", csv, "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  std::ifstream in(json);
  const auto document = nlohmann::json::parse(in);
  CHECK(document.at("width") == 160);
  CHECK_FALSE(document.at("gl").at("renderer").get<std::string>().empty());
  std::map<std::string, std::map<std::string, nlohmann::json>> rows;
  for (const auto& row : document.at("rows")) {
    const std::string mesher =
        row.at("mesher").get<std::string>() + " " + row.at("path").get<std::string>();
    CHECK(rows[row.at("world")].emplace(mesher, row).second);
    CAPTURE(row.dump());
    CHECK(row.at("p50_ms") > 0);
    CHECK(row.at("p50_ms") <= row.at("p99_ms"));
    CHECK(row.at("frames") >= 2);
    CHECK(row.at("frames") <= 4);
    if (mesher == "none plain" || mesher == "rdm product") {
      CHECK(row.at("overdraw").is_null());
      if (mesher == "rdm product") CHECK(row.at("pinhole_pixels") == 0);
      continue;
    }
    if (row.at("path") == "quads") {
      CHECK(row.at("upload_bytes") == 2 * row.at("vertices").get<std::size_t>());
    } else {
      CHECK(row.at("upload_bytes") == bytes_of(row));
    }
    CHECK(row.at("overdraw") >= 1);
    CHECK(row.at("depth_complexity") >= row.at("overdraw"));
    if (!row.at("lanes").is_null()) {
      CHECK(row.at("lanes") >= 1);
      CHECK(row.at("lanes") <= 4);
    }
    CHECK(row.at("seam_pixels") >= row.at("pinhole_pixels"));
    CHECK(row.at("seam_pixels") < 0.02 * row.at("covered_pixels").get<double>());
  }
  REQUIRE(rows.size() == 3);
  for (const auto& [world, of] : rows) {
    CAPTURE(world);
    CHECK(of.size() == 7);
    CHECK(of.at("none plain").at("vertices") == 0);
    CHECK(of.at("culled plain").at("seam_pixels") == 0);
    CHECK(of.at("culled plain").at("t_junctions") == 0);
    CHECK(of.at("rdm plain").at("seam_pixels") == of.at("rdm_plain plain").at("seam_pixels"));
    CHECK(of.at("rdm plain").at("vertices") == of.at("rdm product").at("vertices"));
    CHECK(of.at("rdm plain").at("vertices") == of.at("rdm quads").at("vertices"));
    CHECK(of.at("rdm plain").at("depth_complexity") == of.at("rdm quads").at("depth_complexity"));
    CHECK(of.at("rdm product").at("upload_bytes") ==
          of.at("rdm product").at("vertices").get<std::size_t>() * 2);
    CHECK(of.at("rdm plain").at("vertices") < of.at("culled plain").at("vertices"));
    CHECK(of.at("rdm plain").at("lanes") <= of.at("culled plain").at("lanes"));
    CHECK(of.at("rle_rdm plain").at("depth_complexity") >
          of.at("culled plain").at("depth_complexity"));
  }
  // The thesis' counts: 1080 vertices a chunk, and 54 faces of whole chunks around the 27.
  CHECK(rows["scenario_6"]["culled plain"].at("vertices") == 27 * 1080);
  CHECK(rows["scenario_1"]["rdm plain"].at("vertices") == 4 * 54);
  CHECK(rows["scenario_1"]["rdm plain"].at("depth_complexity") == 1);
  CHECK(output.out.find("| rdm, product |") != std::string::npos);
  CHECK(output.err.find("scenario_6: 27 chunks") != std::string::npos);
}

TEST_CASE("without the culled mesher seams are still counted against its picture", "[frames]") {
  if (!has_context()) return;
  const test::TempFolder folder;
  const std::string json = folder / "frames.json";
  const BenchOutput output = run({"--worlds", "scenario_2", "--meshers", "rdm", "--frames", "3",
                                  "--pictures", "1", "--size", "64x36", "--json", json});
  REQUIRE(output.exit_code == 0);
  std::ifstream in(json);
  const auto document = nlohmann::json::parse(in);
  REQUIRE(document.at("rows").size() == 2);
  CHECK(document.at("rows").at(1).at("mesher") == "rdm");
  CHECK(document.at("rows").at(1).at("seam_pixels").is_number());
}

TEST_CASE("a mesh that is too large is named instead", "[frames]") {
  if (!has_context()) return;
  const BenchOutput output = run({"--worlds", "scenario_6", "--meshers", "simple,culled,rdm",
                                  "--frames", "3", "--size", "64x36", "--vertices-max", "20000"});
  REQUIRE(output.exit_code == 0);
  CHECK(output.out.find("skipped: scenario_6 simple: more than 20000 vertices") !=
        std::string::npos);
  CHECK(output.out.find("| rdm |") != std::string::npos);
  CHECK(output.out.find("| simple |") == std::string::npos);
  // The culled mesh has 29,160 vertices and is drawn, because the others are compared with it.
  CHECK(output.out.find("| culled |") != std::string::npos);
}

TEST_CASE("runstone-bench frames rejects options that it cannot satisfy", "[frames]") {
  const auto refused = [](const std::vector<std::string>& arguments, const char* why) {
    const BenchOutput output = run(arguments);
    CAPTURE(output.err);
    CHECK(output.exit_code != 0);
    CHECK(output.err.find(why) != std::string::npos);
  };
  refused({"--worlds", "scenario_38"}, "scenario_38");
  refused({"--meshers", "marching_cubes"}, "marching_cubes");
  refused({"--size", "640*360"}, "640*360: not a size");
  refused({"--frames", "2"}, "--frames");
  refused({"--luanti", "/nowhere"}, "/nowhere");
}
