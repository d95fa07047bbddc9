// The benchmark as a program: its files contain what the command line names, and its counts are
// right. No test checks times.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "bench/meshing/mesher_case.hpp"
#include "bench/storage/stores.hpp"
#include "bench/wire/transfer_form.hpp"
#include "tests/integration/bench/bench_output.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::bench;

namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

using CsvRow = std::map<std::string, std::string>;

/// Reads rows by the names in the first line.
std::vector<CsvRow> read_csv(const std::string& file) {
  const auto cells = [](const std::string& line) {
    std::vector<std::string> out;
    std::istringstream in(line + ',');
    for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
    return out;
  };
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = cells(line);
  std::vector<CsvRow> out;
  while (std::getline(in, line)) {
    const std::vector<std::string> values = cells(line);
    REQUIRE(values.size() == names.size());
    CsvRow& row = out.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = values[i];
  }
  return out;
}

}  // namespace

TEST_CASE("runstone-bench mesh has a row for every mesher in every cell", "[bench]") {
  const test::TempFolder folder;
  const std::string csv = folder / "mesh.csv", json = folder / "mesh.json";
  const BenchOutput output =
      run_bench({"mesh", "--quick", "--worlds", "hills,town,checkerboard,uniform,scenarios,luanti",
                 "--edges", "32", "--csv", csv, "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);

  const std::vector<CsvRow> rows = read_csv(csv);
  std::map<std::string, std::set<std::string>> meshers;  // by world and part
  std::map<std::string, std::set<std::string>> parts;    // by world
  std::map<std::string, std::map<std::string, std::size_t>> quads;
  // The number of triangles of the polygon meshers. All have the same number.
  std::map<std::string, std::set<std::string>> triangles;
  std::size_t t_junctions = 0;
  for (const CsvRow& row : rows) {
    const std::string cell = row.at("world") + " " + row.at("part");
    CAPTURE(cell, row.at("mesher"));
    CHECK(meshers[cell].insert(row.at("mesher")).second);
    parts[row.at("world")].insert(row.at("part"));
    quads[cell][row.at("mesher")] = std::stoul(row.at("quads"));
    CHECK(row.at("edge") == "32");
    CHECK(row.at("rank") == "best");
    CHECK(row.at("allocations") == "0");
    if (row.at("mesher") == "monotone" || row.at("mesher") == "poly2tri") {
      CHECK(row.at("quads") == "0");
      triangles[cell].insert(row.at("triangles"));
      CHECK(std::stoul(row.at("mesh_bytes")) ==
            3 * std::stoul(row.at("vertices")) + 16 * std::stoul(row.at("triangles")));
    } else {
      CHECK(std::stoul(row.at("vertices")) == 4 * std::stoul(row.at("quads")));
      CHECK(std::stoul(row.at("triangles")) == 2 * std::stoul(row.at("quads")));
      CHECK(std::stoul(row.at("mesh_bytes")) == 8 * std::stoul(row.at("quads")));
    }
    // Edges of unit length have no room for a T-junction.
    if (row.at("mesher") == "culled") CHECK(row.at("t_junctions") == "0");
    CHECK(std::stoul(row.at("t_junctions")) <= std::stoul(row.at("t_junction_edges")));
    t_junctions += std::stoul(row.at("t_junctions"));
    CHECK(std::stoul(row.at("thin_100")) <= std::stoul(row.at("thin_16")));
    CHECK(std::stod(row.at("median_ns")) > 0);
    CHECK(std::stod(row.at("min_ns")) <= std::stod(row.at("median_ns")));
    CHECK_FALSE(row.at("against_decode").empty());
  }
  CHECK(parts["scenarios"].size() == 37);
  CHECK(parts["luanti"].size() > 20);
  for (const char* world : {"hills", "town", "checkerboard", "uniform"})
    CHECK(parts[world].size() == 1);

  const auto all = mesher_case_names();
  std::map<std::string, std::size_t> sums;
  for (const auto& [cell, names] : meshers) {
    CAPTURE(cell);
    CHECK(names.size() == all.size());
    CHECK(triangles[cell].size() == 1);
    const auto& of = quads[cell];
    CHECK(of.at("rdm") == of.at("rdm_plain"));
    CHECK(of.at("decode_binary") == of.at("grid_binary"));
    CHECK(of.at("decode_binary") == of.at("mask_binary"));
    CHECK(of.at("rdm") <= of.at("culled"));
    CHECK(of.at("culled") <= of.at("simple"));
    for (const char* merged :
         {"rdm", "decode_binary", "greedy", "naive_greedy", "run_strips", "grid_rdm"}) {
      CHECK(of.at("optimal_greedy") <= of.at(merged));
    }
    CHECK(of.at("run_strips_hidden") <= of.at("run_strips"));
    for (const auto& [mesher, count] : of) sums[mesher] += count;
  }
  CHECK(static_cast<double>(sums["rdm"]) <= 1.03 * static_cast<double>(sums["decode_binary"]));
  CHECK(t_junctions > 1000);
  CHECK(quads["checkerboard 0 -16 0"]["culled"] == 32 * 32 * 32 / 2 * 6);
  CHECK(quads["uniform 0 -16 0"]["rdm"] == 0);

  const auto document = nlohmann::json::parse(text_of(json));
  CHECK(document.at("rows").size() == rows.size());
  CHECK(document.at("repetitions") == 3);
  CHECK(document.at("summary").size() == 16);
  CHECK(output.out.find("| rdm |") != std::string::npos);
}

TEST_CASE("runstone-bench mesh names the cells it leaves out", "[bench]") {
  const BenchOutput output = run_bench({"mesh", "--quick", "--worlds", "empty,scenarios", "--edges",
                                        "65,8", "--meshers", "rdm,decode_binary"});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  for (const char* cell :
       {"skipped: empty 0 -32 0 edge 65 order xyz decode_binary: sides above 64",
        "skipped: scenarios edge 65: the models have edges of 8, 16, 32, 64 and 128",
        "skipped: scenarios edge 8: scenario 5 is data of edge 32"}) {
    CAPTURE(cell);
    CHECK(output.out.find(cell) != std::string::npos);
  }
}

TEST_CASE("runstone-bench mesh-once prints a line for each world that it meshed", "[bench]") {
  const BenchOutput output = run_bench({"mesh-once", "--worlds", "town,checkerboard", "--edges",
                                        "16", "--mesher", "culled", "--times", "3"});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  std::istringstream lines(output.out);
  std::map<std::string, nlohmann::json> worlds;
  for (std::string line; std::getline(lines, line);) {
    const auto world = nlohmann::json::parse(line);
    worlds[world.at("world")] = world;
  }
  REQUIRE(worlds.size() == 2);
  CHECK(worlds["checkerboard"].at("quads") == 16 * 16 * 16 / 2 * 6);
  CHECK(worlds["checkerboard"].at("meshes") == 3);
  CHECK(worlds["town"].at("mesher") == "culled");
  const BenchOutput none =
      run_bench({"mesh-once", "--worlds", "hills", "--edges", "65", "--mesher", "mask_binary"});
  CHECK(none.exit_code == 1);
  CHECK(none.err.find("hills edge 65: nothing for mask_binary") != std::string::npos);
}

TEST_CASE("runstone-bench mesh takes any axis order", "[bench]") {
  const test::TempFolder folder;
  const std::string csv = folder / "orders.csv";
  REQUIRE(run_bench({"mesh", "--quick", "--worlds", "hills", "--orders", "all", "--meshers", "rdm",
                     "--csv", csv})
              .exit_code == 0);
  const std::vector<CsvRow> rows = read_csv(csv);
  REQUIRE(rows.size() == 6);
  std::set<std::string> orders;
  std::map<std::string, std::size_t> runs;
  for (const CsvRow& row : rows) {
    orders.insert(row.at("order"));
    const std::size_t count = std::stoul(row.at("runs"));
    auto& known = runs.try_emplace(row.at("rank"), count).first->second;
    known = row.at("rank") == "best" ? std::min(known, count) : std::max(known, count);
  }
  CHECK(orders == std::set<std::string>{"xyz", "xzy", "yxz", "yzx", "zxy", "zyx"});
  CHECK(runs.at("best") < runs.at("between"));
  CHECK(runs.at("between") <= runs.at("worst"));
}

TEST_CASE("runstone-bench edit-to-mesh meshes layers after each brush", "[bench]") {
  const test::TempFolder folder;
  const std::string csv = folder / "brushes.csv";
  const BenchOutput output = run_bench(
      {"edit-to-mesh", "--worlds", "hills", "--edges", "32", "--min-runs", "2", "--csv", csv});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  CHECK(output.out.find("worst median") != std::string::npos);
  std::set<std::string> brushes;
  for (const CsvRow& row : read_csv(csv)) {
    CHECK(brushes.insert(row.at("brush") + row.at("neighbours")).second);
    CHECK(std::stoul(row.at("edits")) > 0);
    if (row.at("brush") == "voxel") CHECK(row.at("by_layers") == "1.000");
  }
  CHECK(brushes.size() == 2 * 13);
}

TEST_CASE("runstone-bench chunk-edge cuts the same voxels at every edge", "[bench]") {
  const test::TempFolder folder;
  const std::string csv = folder / "edges.csv";
  const BenchOutput output =
      run_bench({"chunk-edge", "--worlds", "town", "--edges", "32,64", "--csv", csv});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  const std::vector<CsvRow> rows = read_csv(csv);
  REQUIRE(rows.size() == 2);
  for (const CsvRow& row : rows) {
    CHECK(row.at("voxels") == std::to_string(128 * 128 * 128));
    CHECK(std::stoul(row.at("chunks")) * std::stoul(row.at("edge")) * std::stoul(row.at("edge")) *
              std::stoul(row.at("edge")) ==
          128 * 128 * 128);
    CHECK(std::stoul(row.at("memory_bytes")) > std::stoul(row.at("run_bytes")));
  }
  CHECK(std::stoul(rows[0].at("quads")) > std::stoul(rows[1].at("quads")));  // borders cut them
}

TEST_CASE("runstone-bench voxelise compares runs with a byte grid and with an oracle", "[bench]") {
  const test::TempFolder folder;
  const std::string json = folder / "voxelise.json";
  const BenchOutput output = run_bench(
      {"voxelise", "--triangles", "2000", "--edges", "48,80", "--min-runs", "1", "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  const auto rows = nlohmann::json::parse(text_of(json)).at("rows");
  REQUIRE(rows.size() == 2 * 6);
  std::map<std::string, std::uint64_t> voxels;
  for (const auto& row : rows) {
    CHECK(row.at("compared") > 1'000);
    CHECK(row.at("differing") == 0);
    CHECK(row.at("runs") > 100);
    if (row.at("side") == 80) voxels[row.at("way")] = row.at("voxels");
  }
  CHECK(voxels.at("solid") == voxels.at("solid, byte grid"));
  CHECK(voxels.at("surface, conservative") > voxels.at("surface, 26-separating"));
  CHECK(voxels.at("surface, 26-separating") > voxels.at("surface, 6-separating"));
  CHECK(run_bench({"voxelise", "--edges", "8"}).exit_code == 2);
}

TEST_CASE("runstone-bench rejects unknown options and values", "[bench]") {
  CHECK(run_bench({}).exit_code == 2);
  CHECK(run_bench({"mesh", "--worlds", "atlantis"}).exit_code == 2);
  CHECK(run_bench({"mesh", "--meshers", "marching_cubes"}).exit_code == 2);
  CHECK(run_bench({"mesh", "--edges", "7"}).exit_code == 2);
  CHECK(run_bench({"mesh", "--help"}).exit_code == 0);
  const test::TempFolder folder;
  const BenchOutput nothing =
      run_bench({"mesh", "--quick", "--worlds", "luanti", "--luanti", folder.path()});
  CHECK(nothing.exit_code == 1);
  CHECK(nothing.err.find("map.sqlite") != std::string::npos);
  const BenchOutput odd = run_bench({"chunk-edge", "--worlds", "town", "--edges", "62"});
  CHECK(odd.exit_code == 1);
  CHECK(odd.err.find("edge 62") != std::string::npos);
  const std::string nowhere = folder / "no/such.csv";
  CHECK(run_bench({"mesh", "--quick", "--worlds", "empty", "--csv", nowhere}).exit_code == 1);
}

TEST_CASE("the costs of an edit at two servers are measured, and the table has them", "[bench]") {
  const test::TempFolder folder;
  const std::string json = folder / "relay.json";
  const BenchOutput output = run_bench({"relay", "--min-runs", "1", "--json", json});
  REQUIRE(output.exit_code == 0);
  const auto rows = nlohmann::json::parse(text_of(json));
  REQUIRE(rows.size() == 2);
  CHECK(rows[0]["commit_edits"] == 1);
  CHECK(rows[1]["commit_edits"] == 10);
  for (const auto& row : rows) {
    for (const char* cost :
         {"owner_local_us", "owner_relayed_us", "follower_local_us", "follower_remote_us"})
      CHECK(row[cost] > 0);
  }
  CHECK(output.out.find("| 10 edits | ") != std::string::npos);
}

TEST_CASE("runstone-bench fan-out compares the server's sessions with a loop of system calls",
          "[bench]") {
  const test::TempFolder folder;
  const std::string json = folder / "fan_out.json";
  const BenchOutput output =
      run_bench({"fan-out", "--clients", "70", "--min-runs", "1", "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  const auto result = nlohmann::json::parse(text_of(json));
  CHECK(result["receivers"] == 70);
  REQUIRE(result["rows"].size() == 12);
  for (const auto& row : result["rows"]) {
    CHECK(row["floor_us"] > 0);
    CHECK(row["sessions_us"] > 0);
  }
  CHECK(output.out.find("| 2500 | yes | 20 | ") != std::string::npos);
}

TEST_CASE("runstone-bench edits has a row for every case and judges every target", "[bench]") {
  const test::TempFolder folder;
  const std::string csv = folder / "edits.csv", json = folder / "edits.json";
  const BenchOutput output =
      run_bench({"edits", "--min-runs", "1", "--edits", "300", "--csv", csv, "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  std::map<std::string, std::size_t> edits;
  for (const CsvRow& row : read_csv(csv)) {
    CAPTURE(row.at("case"));
    CHECK(std::stod(row.at("median_us")) > 0);
    CHECK(std::stoul(row.at("chunks")) > 0);
    edits[row.at("case")] += std::stoul(row.at("edits"));
  }
  CHECK(edits.size() == 15);
  CHECK(edits["mixed edits by hand as a stack"] == 1111);
  const auto targets = nlohmann::json::parse(text_of(json)).at("bars");
  CHECK(targets.size() == 9);
  for (const auto& target : targets) CHECK(target.at("verdict") != "not measured");
}

TEST_CASE("runstone-bench log opens moments with keyframes and without, and previews a rollback",
          "[bench]") {
  const test::TempFolder folder;
  const std::string json = folder / "log.json";
  const BenchOutput output =
      run_bench({"log", "--edits", "70000", "--min-runs", "2", "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  const auto document = nlohmann::json::parse(text_of(json));
  CHECK(document.at("edits") == 70'000);
  CHECK(document.at("bytes_an_edit") > 50);
  CHECK(document.at("keyframe_bytes_an_edit") > 0);
  CHECK(document.at("keyframe_chunks") > 50);
  REQUIRE(document.at("moments").size() == 2);
  CHECK(document.at("moments")[0].at("keyframes") == 0);
  CHECK(document.at("moments")[1].at("keyframes") == 2);
  CHECK(document.at("moments")[1].at("chunks") == document.at("moments")[0].at("chunks"));
  CHECK(document.at("moments")[1].at("edits_read") <= document.at("moments")[0].at("edits_read"));
  CHECK(document.at("questions").size() == 6);
  const auto& previews = document.at("previews");
  REQUIRE(previews.size() == 4);
  for (const auto& preview : previews) {
    CHECK(preview.at("edits") > 1'000);
    CHECK(preview.at("chunks") > 1);
    CHECK(preview.at("voxels") > 100);
    CHECK(preview.at("preview_ms") >= preview.at("count_ms"));
  }
}

TEST_CASE("runstone-bench bytes has every form of the same chunks", "[bench]") {
  const test::TempFolder folder;
  const std::string csv = folder / "bytes.csv", json = folder / "bytes.json";
  const BenchOutput output =
      run_bench({"bytes", "--min-runs", "1", "--worlds", "luanti,hills,scenarios,uniform", "--csv",
                 csv, "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  std::map<std::string, std::map<std::string, double>> bytes;  // by world and set, then form
  for (const CsvRow& row : read_csv(csv)) {
    CAPTURE(row.at("world"), row.at("set"), row.at("form"));
    bytes[row.at("world") + " " + row.at("set")][row.at("form")] = std::stod(row.at("bytes"));
    CHECK(std::stod(row.at("encode_us")) > 0);
    CHECK(std::stod(row.at("decode_us")) > 0);
    const std::string chunks = row.at("world") == "scenarios" ? "37"
                               : row.at("world") == "luanti"  ? "48"
                                                              : "64";
    if (row.at("set") == "all") CHECK(row.at("chunks") == chunks);
  }
  CHECK(bytes.size() == 7);  // no chunk of the uniform world is mixed
  for (const auto& [cell, forms] : bytes) {
    CAPTURE(cell);
    CHECK(forms.size() == transfer_form_names().size());
    CHECK(forms.at("dense") == 65536);
    CHECK(forms.at("luanti") < forms.at("luanti_light") + 0.5);
  }
  CHECK(bytes["luanti all"]["luanti_light"] >
        1.05 * bytes["luanti all"]["luanti"]);  // the game's light
  CHECK(bytes["uniform all"]["raw"] == 16);
  const auto targets = nlohmann::json::parse(text_of(json)).at("bars");
  for (const auto& target : targets) {
    const bool terrain =
        target.at("case").get<std::string>().find("noise terrain") != std::string::npos;
    CHECK((target.at("verdict") == "not measured") == terrain);
  }
}

TEST_CASE("runstone-bench bytes-to-quads takes both ways over the same chunks", "[bench]") {
  const test::TempFolder folder;
  const std::string json = folder / "quads.json";
  const BenchOutput output =
      run_bench({"bytes-to-quads", "--min-runs", "1", "--worlds", "luanti,empty", "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  CHECK(output.out.find("packed bytes to quads") != std::string::npos);
  const auto document = nlohmann::json::parse(text_of(json));
  const auto& rows = document.at("rows");
  REQUIRE(rows.size() == 2);  // no chunk of the empty world is measured
  for (const auto& row : rows) {
    CAPTURE(row.at("world"));
    const bool is_empty = row.at("world") == "empty";
    CHECK((row.at("chunks") == 0) == is_empty);
    if (is_empty) continue;
    CHECK(row.at("runs").at("bytes") < row.at("dense").at("bytes"));
    for (const char* way : {"runs", "dense"}) {
      CHECK(row.at(way).at("unpack_us") > 0);
      CHECK(row.at(way).at("mesh_us") > 0);
    }
  }
}

TEST_CASE("runstone-bench veil measures chunks with and without a veil", "[bench]") {
  const test::TempFolder folder;
  const std::string json = folder / "veil.json";
  const BenchOutput output =
      run_bench({"veil", "--min-runs", "1", "--worlds", "luanti", "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  const auto document = nlohmann::json::parse(text_of(json));
  REQUIRE(document.at("rows").size() == 1);
  const auto& row = document.at("rows")[0];
  CHECK(row.at("chunks") > 0);
  CHECK(row.at("veiled").at("runs") < row.at("plain").at("runs"));
  CHECK(row.at("veiled").at("bytes") < row.at("plain").at("bytes"));
  CHECK(row.at("turned").at("runs") <= row.at("veiled").at("runs"));
  for (const char* form : {"plain", "veiled", "turned"}) {
    CHECK(row.at(form).at("unpack_us") > 0);
    CHECK(row.at(form).at("mesh_us") > 0);
    CHECK(row.at(form).at("quads") > 0);
  }
  CHECK(row.at("veil_us") > 0);
  CHECK(row.at("uncover_us") > 0);
}

TEST_CASE("runstone-bench tiles measures each level of a world", "[bench]") {
  const test::TempFolder folder;
  const std::string json = folder / "tiles.json";
  const BenchOutput output =
      run_bench({"tiles", "--min-runs", "1", "--worlds", "luanti", "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  CHECK(output.out.find("making all tiles") != std::string::npos);
  const auto document = nlohmann::json::parse(text_of(json));
  const auto& rows = document.at("rows");
  REQUIRE(rows.size() == 11);
  for (std::size_t level = 0; level < 5; ++level) {
    CAPTURE(level);
    const auto& row = rows[level];
    CHECK(row.at("level") == level);
    CHECK(row.at("coded_bytes") > 0);
    CHECK(row.at("tiles") > 0);
    CHECK(row.at("veiled_runs") <= row.at("runs"));
    CHECK((row.at("make_us") > 0) == (level > 0));
    CHECK((row.at("veil_us") > 0) == (level > 0));
    CHECK(row.at("veiled_bytes") <= row.at("bytes"));
    CHECK(row.at("coded_bytes") < row.at("veiled_bytes"));
    if (level > 0) CHECK(row.at("tiles") <= rows[level - 1].at("tiles"));
  }
  // The world repeated sideways has levels 1 to 6, and no times.
  for (std::size_t level = 1; level < 7; ++level) {
    const auto& row = rows[4 + level];
    CHECK(row.at("level") == level);
    CHECK(row.at("veiled_bytes") > 0);
    CHECK(row.at("decode_us") == 0);
  }
  // Making, the bytes of levels 1 to 4, and those of two views.
  CHECK(document.at("targets").size() == 7);
}

TEST_CASE("runstone-bench scenario-facts counts all chunks of the thesis' scenarios", "[bench]") {
  const test::TempFolder folder;
  const std::string json = folder / "facts.json";
  const BenchOutput output = run_bench({"scenario-facts", "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  const auto rows = nlohmann::json::parse(text_of(json)).at("rows");
  REQUIRE(rows.size() == 37);
  CHECK(rows[0].at("chunks_without_quads") == 1);  // the chunk in the middle of 27 full ones
  CHECK(rows[16].at("opaque") == 16384);           // the chessboard
  CHECK(rows[16].at("runs_zyx") == 31776);         // lines meet in 992 runs
  CHECK(output.out.find("| scenario | group |") != std::string::npos);
}

TEST_CASE("runstone-bench machine writes what results are compared by", "[bench]") {
  const test::TempFolder folder;
  const std::string json = folder / "machine.json";
  REQUIRE(run_bench({"machine", "--json", json}).exit_code == 0);
  const auto machine = nlohmann::json::parse(text_of(json));
  for (const char* field : {"cpu", "cores", "compiler", "commit", "simd"}) {
    CAPTURE(field);
    CHECK(machine.contains(field));
  }
  CHECK(run_bench({"machine", "--json", folder / "no/such.json"}).exit_code == 1);
}

TEST_CASE("runstone-bench storage has a row for every store on every volume", "[bench]") {
  const test::TempFolder folder;
  const std::string csv = folder / "storage.csv", json = folder / "storage.json";
  const BenchOutput output =
      run_bench({"storage", "--worlds", "hills,checkerboard,empty,luanti,scenarios", "--edges",
                 "16,32", "--min-runs", "1", "--csv", csv, "--json", json});
  INFO(output.err);
  REQUIRE(output.exit_code == 0);
  const std::vector<CsvRow> rows = read_csv(csv);
  std::map<std::string, std::map<std::string, CsvRow>> cells;
  std::map<std::string, std::set<std::string>> parts;  // by world and edge
  for (const CsvRow& row : rows) {
    CAPTURE(row.at("world"), row.at("part"), row.at("edge"), row.at("store"));
    for (const char* figure : {"build_ns", "read_ns", "walk_ns", "edit_ns", "brush_ns"}) {
      CAPTURE(figure);
      CHECK(std::stod(row.at(figure)) > 0);
    }
    CHECK(std::stod(row.at("brush_voxels")) > 100);
    CHECK(std::stod(row.at("brush_voxels")) < 739);  // all of a ball; edges cut off some
    parts[row.at("world") + " " + row.at("edge")].insert(row.at("part"));
    CHECK(cells[row.at("world") + " " + row.at("part") + " " + row.at("edge")]
              .emplace(row.at("store"), row)
              .second);
  }
  CHECK(parts["scenarios 32"].size() == 37);
  CHECK(parts["scenarios 16"].size() == 36);
  CHECK(parts["luanti 32"].size() > 20);
  for (const auto& [cell, stores] : cells) {
    CAPTURE(cell);
    CHECK(stores.size() == bench::storage::store_names().size());
    const std::size_t voxels = stores.at("flat").at("edge") == "16" ? 4096 : 32768;
    const auto bytes = [&](const char* store) { return std::stoul(stores.at(store).at("bytes")); };
    CHECK(bytes("flat") > 2 * voxels);
    CHECK(bytes("flat") < 2 * voxels + 100);
    CHECK(bytes("morton") < 2 * voxels + 100);
    CHECK(bytes("runs") >= 4 * std::stoul(stores.at("runs").at("runs")));
    CHECK(bytes("interval_map") > 48 * std::stoul(stores.at("runs").at("runs")));
  }
  CHECK(std::stoul(cells["empty 0 -16 0 32"]["octree"].at("bytes")) < 200);
  CHECK(std::stoul(cells["checkerboard 0 -16 0 32"]["octree"].at("bytes")) > 65536);
  // One leaf, and one node for each height.
  CHECK(std::stoul(cells["checkerboard 0 -16 0 32"]["dag"].at("bytes")) < 1000);

  const auto document = nlohmann::json::parse(text_of(json));
  CHECK(document.at("rows").size() == rows.size());
  CHECK(document.at("repetitions") == 1);
  CHECK(document.at("machine").contains("commit"));
  CHECK((document.at("morton_code") == "pdep" || document.at("morton_code") == "table"));
  for (const char* group : {"landscapes", "patterns", "luanti", "scenarios"}) {
    CAPTURE(group);
    for (const char* edge : {"16", "32"}) {
      CHECK(output.out.find(std::string("**") + group + "**, edge " + edge) != std::string::npos);
    }
  }
  CHECK(output.out.find("skipped: scenarios edge 16: scenario 5 is data of edge 32") !=
        std::string::npos);

  const BenchOutput odd = run_bench({"storage", "--worlds", "hills", "--edges", "62"});
  CHECK(odd.exit_code == 1);
  CHECK(odd.err.find("edge 62") != std::string::npos);
}
