#ifdef RUNSTONE_CLIENT_PROGRAM  // not in a build without the client
// The network benchmark as a program: every experiment, small, over links that this process may
// make. No test checks times.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/app/bench_program.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::bench;
using nlohmann::json;

namespace {

/// Returns the JSON of a run. Requires exit code 0.
json run_testbed(std::vector<std::string> arguments, std::string& tables) {
  ::setenv("RUNSTONE_SERVER", RUNSTONE_SERVER_PROGRAM, 1);
  ::setenv("RUNSTONE_CLIENT", RUNSTONE_CLIENT_PROGRAM, 1);
  ::setenv("RUNSTONE_BOT", RUNSTONE_BOT_PROGRAM, 1);
  ::setenv("RUNSTONE_WEB", RUNSTONE_WEB_PROGRAM, 1);
  const test::TempFolder folder;
  const std::string file = folder / "testbed.json", csv = folder / "testbed.csv";
  arguments.insert(arguments.begin(),
                   {"net", "--quick", "--edits", "20", "--json", file, "--csv", csv});
  std::vector<const char*> argv = {"runstone-bench"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream out, err;
  const int code = bench_program(static_cast<int>(argv.size()), argv.data(), out, err);
  INFO(err.str());
  REQUIRE(code == 0);
  tables = out.str();
  json written = json::parse(std::ifstream(file));
  std::ifstream lines(csv);
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);) ++rows;
  CHECK(rows == written["figures"].size() + 1);
  return written;
}

double figure(const json& testbed, const std::string& experiment, const std::string& what,
              const std::string& name) {
  for (const json& it : testbed["figures"]) {
    if (it["experiment"] == experiment && it["case"] == what && it["figure"] == name)
      return it["value"].get<double>();
  }
  FAIL("no figure " << experiment << " " << what << " " << name);
  return 0;
}

/// Returns how connections of the attackers ended in a row. On a slow machine a row may end before
/// the server has answered any of them.
std::set<std::string> endings(const json& testbed, const std::string& experiment,
                              const std::string& what) {
  constexpr std::string_view kTold = "told ";
  std::set<std::string> out;
  for (const json& it : testbed["figures"]) {
    const auto name = it["figure"].get<std::string>();
    if (it["experiment"] == experiment && it["case"] == what && name.rfind(kTold, 0) == 0)
      out.insert(name.substr(kTold.size()));
  }
  return out;
}

}  // namespace

TEST_CASE("the testbed measures joins and edits over a link", "[testbed]") {
  std::string tables;
  const json testbed = run_testbed({"--experiments", "join,latency", "--profiles", "lan"}, tables);
  CHECK(figure(testbed, "join", "median", "near_most_ms") > 0);
  CHECK(figure(testbed, "join", "median", "near_most_ms") <=
        figure(testbed, "join", "median", "view_all_ms"));
  for (const char* load : {"idle", "streaming", "streaming 20 clients"}) {
    CAPTURE(load);
    CHECK(figure(testbed, "latency", load, "remote_edits") > 0);
    CHECK(figure(testbed, "latency", load, "remote_never_meshed") == 0);
    CHECK(figure(testbed, "latency", load, "remote_meshed_p50_ms") > 0);
    CHECK(figure(testbed, "latency", load, "echo_p50_ms") >= 0.4);
    CHECK(figure(testbed, "latency", load, "drifted_chunks") == 0);
  }
  CHECK(figure(testbed, "latency", "streaming", "terrain_kb_s") > 0);
  CHECK(tables.find("| remote edit: meshed |") != std::string::npos);
  CHECK_FALSE(testbed["bars"].empty());
}

TEST_CASE("the testbed measures joins to the horizon", "[testbed]") {
  std::string tables;
  const json testbed = run_testbed({"--experiments", "horizon", "--profiles", "loopback"}, tables);
  for (const char* far : {"sees 192", "sees 384"}) {
    CAPTURE(far);
    CHECK(figure(testbed, "horizon", far, "coarse_ms") > 0);
    CHECK(figure(testbed, "horizon", far, "coarse_ms") <=
          figure(testbed, "horizon", far, "all_ms"));
    CHECK(figure(testbed, "horizon", far, "bytes") >
          figure(testbed, "horizon", "sees 96", "bytes"));
  }
  CHECK(tables.find("### Horizon") != std::string::npos);
}

TEST_CASE("the testbed measures transfers without privileges", "[testbed]") {
  std::string tables;
  const json testbed = run_testbed(
      {"--experiments", "transfer", "--profiles", "lan", "--worlds", "terrain", "--link", "shaper"},
      tables);
  CHECK(figure(testbed, "transfer", "terrain dense", "bytes") > 64 * 65536);
  CHECK(figure(testbed, "transfer", "terrain packed", "bytes") <
        figure(testbed, "transfer", "terrain raw", "bytes"));
  CHECK(figure(testbed, "transfer", "terrain packed", "complete_ms") >= 0.4);
  CHECK(testbed["figures"][0]["link"] == "shaper");
  CHECK(tables.find("a TCP proxy on loopback") != std::string::npos);
}

TEST_CASE("the testbed measures fleets", "[testbed]") {
  std::string tables;
  const json testbed =
      run_testbed({"--experiments", "crowd", "--clients", "3", "--crowd-seconds", "1"}, tables);
  CHECK(figure(testbed, "crowd", "3 clients", "samples") > 0);
  CHECK(figure(testbed, "crowd", "3 clients", "disconnects") == 0);
  CHECK(figure(testbed, "crowd", "3 clients", "edits") > 0);
  CHECK(figure(testbed, "crowd", "3 clients", "received_kb_s_each") > 0);
  CHECK(figure(testbed, "crowd", "3 clients", "enqueue_us_per_receiver") > 0);
  double in_rows = 0;
  for (const json& it : testbed["figures"]) {
    if (it["figure"].get<std::string>().rfind("samples_", 0) == 0)
      in_rows += it["value"].get<double>();
  }
  CHECK(in_rows == figure(testbed, "crowd", "3 clients", "samples"));
  CHECK(tables.find("These latencies of 3 clients:\n\n| from, below ms | samples |") !=
        std::string::npos);
}

TEST_CASE("the testbed measures what the gateway costs", "[testbed]") {
  std::string tables;
  const json testbed = run_testbed(
      {"--experiments", "gateway", "--gateway-bots", "3", "--crowd-seconds", "1"}, tables);
  for (const char* frames : {"ping and pong", "edit and commit"}) {
    CAPTURE(frames);
    CHECK(figure(testbed, "gateway", frames, "tcp_p50_ms") > 0);
    CHECK(figure(testbed, "gateway", frames, "gateway_p99_ms") > 0);
  }
  for (const char* way : {"3 bots by TCP", "3 bots by gateway"}) {
    CAPTURE(way);
    CHECK(figure(testbed, "gateway", way, "samples") > 0);
    CHECK(figure(testbed, "gateway", way, "disconnects") == 0);
    CHECK(figure(testbed, "gateway", way, "violations") == 0);
  }
  CHECK(testbed["bars"].size() == 2);
  CHECK(tables.find("### Gateway") != std::string::npos);
}

TEST_CASE("the testbed measures the server's memory of loaded chunks", "[testbed]") {
  std::string tables;
  const json testbed = run_testbed({"--experiments", "memory"}, tables);
  const double cells = figure(testbed, "memory", "real world", "cells");
  CHECK(cells >= 1000);
  CHECK(figure(testbed, "memory", "real world", "mixed") <= cells);
  CHECK(figure(testbed, "memory", "real world", "loaded") >= cells);
  CHECK(figure(testbed, "memory", "real world", "grown_bytes") > 0);
}

TEST_CASE(
    "attacks end with a named rule, and honest clients keep their connections and see no broken "
    "rule",
    "[testbed]") {
  std::string tables;
  const json testbed = run_testbed(
      {"--experiments", "attack", "--attacks",
       "absurd-views,byte-a-second,chunk-requests,claims,half-open,spread-views,teleports,"
       "tiny-chunks,unread-pings,views",
       "--attack-seconds", "1", "--attackers", "2", "--attack-bots", "3"},
      tables);
  for (const char* attack :
       {"quiet", "absurd-views", "byte-a-second", "chunk-requests", "claims", "half-open",
        "spread-views", "teleports", "tiny-chunks", "unread-pings", "views"}) {
    for (const std::string phase : {"before", "during", "after"}) {
      CAPTURE(attack, phase);
      CHECK(figure(testbed, "attack", attack, phase + "_samples") > 0);
      // On a busy machine a bot may leave before the last edits arrive.
      CHECK(figure(testbed, "attack", attack, phase + "_never") <=
            0.2 * figure(testbed, "attack", attack, phase + "_samples"));
      CHECK(figure(testbed, "attack", attack, phase + "_disconnects") == 0);
      CHECK(figure(testbed, "attack", attack, phase + "_violations") == 0);
      CHECK(figure(testbed, "attack", attack, phase + "_server_resident_mb") > 0);
    }
    CHECK(figure(testbed, "attack", attack, "joins_open") ==
          figure(testbed, "attack", attack, "joins_tried"));
    CHECK(figure(testbed, "attack", attack, "server_resident_max_mb") >=
          figure(testbed, "attack", attack, "during_server_resident_mb"));
    CHECK(figure(testbed, "attack", attack, "during_disk_kb_s") > 0);
    CHECK(figure(testbed, "attack", attack, "disk_kb_s_per_attacker") >= 0);
    CHECK(figure(testbed, "attack", attack, "stop_s") > 0);
  }
  CHECK(figure(testbed, "attack", "quiet", "during_p99_of_quiet") == 1);
  CHECK(figure(testbed, "attack", "quiet", "attacker_connections") == 0);
  CHECK(figure(testbed, "attack", "teleports", "attacker_received_mb") > 0);
  CHECK(figure(testbed, "attack", "spread-views", "attacker_received_mb") > 0);
  CHECK(testbed["bars"].size() == 5);
  if (endings(testbed, "attack", "absurd-views").contains("malformed_message")) {
    CHECK(figure(testbed, "attack", "absurd-views", "logged malformed_message") > 0);
    CHECK(tables.find("view radius exceeds 64 chunks") != std::string::npos);
  }
  CHECK(figure(testbed, "attack", "half-open", "attacker_connections") > 0);
  // Beyond 32 connections of an address the server closes them without a word. How many a second
  // brings depends on the machine.
  if (figure(testbed, "attack", "half-open", "attacker_connections") > 64)
    CHECK(figure(testbed, "attack", "half-open", "told closed without a word") > 0);
}

TEST_CASE("newcomers find seats and readers get pages while strangers take both", "[testbed]") {
  std::string tables;
  const json testbed =
      run_testbed({"--experiments", "attack", "--attacks", "seats-by-range,map", "--attack-seconds",
                   "2", "--attackers", "3", "--attack-bots", "3"},
                  tables);
  for (const char* attack : {"quiet", "seats-by-range", "map"}) {
    CAPTURE(attack);
    CHECK(figure(testbed, "attack", attack, "during_disconnects") == 0);
    CHECK(figure(testbed, "attack", attack, "during_violations") == 0);
    CHECK(figure(testbed, "attack", attack, "joins_open") > 0);
    CHECK(figure(testbed, "attack", attack, "joins_open") ==
          figure(testbed, "attack", attack, "joins_tried"));
  }
  CHECK(figure(testbed, "attack", "seats-by-range", "told still connected") > 0);
  for (const std::string phase : {"before", "during", "after"}) {
    for (const std::string page : {"status", "map_state"}) {
      CAPTURE(phase, page);
      CHECK(figure(testbed, "attack", "map", phase + "_" + page + "_answers") > 0);
      CHECK(figure(testbed, "attack", "map", phase + "_" + page + "_failed") == 0);
    }
  }
  // On a busy machine no tile may be drawn in time.
  CHECK(figure(testbed, "attack", "map", "attacker_connections") > 0);
  CHECK(figure(testbed, "attack", "map", "during_gateway_cores") > 0);
  CHECK(testbed["bars"].size() == 7);
  CHECK(tables.find("| map | /map/state.json |") != std::string::npos);
}

TEST_CASE("strangers are held or refused, and builders keep their connections", "[testbed]") {
  std::string tables;
  const json testbed = run_testbed({"--experiments", "strangers", "--attacks",
                                    "silent-sockets,all-strangers", "--attack-seconds", "1"},
                                   tables);
  for (const std::string row :
       {"quiet", "silent-sockets, 1 address(es)", "all-strangers, 1 address(es)",
        "all-strangers, 250 address(es)", "all-strangers, 250 address(es), raised limits"}) {
    CAPTURE(row);
    for (const std::string phase : {"before", "during"}) {
      CAPTURE(phase);
      CHECK(figure(testbed, "strangers", row, phase + "_samples") > 0);
      CHECK(figure(testbed, "strangers", row, phase + "_disconnects") == 0);
      CHECK(figure(testbed, "strangers", row, phase + "_violations") == 0);
      CHECK(figure(testbed, "strangers", row, phase + "_joins_open") > 0);
    }
    CHECK(figure(testbed, "strangers", row, "accepted") > 0);
  }
  CHECK(figure(testbed, "strangers", "quiet", "attacker_connections") == 0);
  CHECK(figure(testbed, "strangers", "all-strangers, 250 address(es)", "attacker_connections") > 0);
  // How many strangers come in the time of a row depends on the machine. Raised limits refuse none.
  CHECK(figure(testbed, "strangers", "silent-sockets, 250 address(es), raised limits", "refused") ==
        0);
  CHECK(testbed["bars"].size() == 3);
  CHECK(tables.find("a byte a second of that message") != std::string::npos);
}

TEST_CASE("floods of messages are read, and builders keep their connections", "[testbed]") {
  std::string tables;
  const json testbed =
      run_testbed({"--experiments", "floods", "--attacks", "Hello,ClientAuth,Ping,EditRequest",
                   "--attack-seconds", "1", "--attackers", "2", "--attacker-addresses", "2"},
                  tables);
  for (const char* row : {"quiet", "Hello, 2 address(es)", "ClientAuth, 2 address(es)",
                          "Ping, 2 address(es)", "EditRequest, 2 address(es)"}) {
    CAPTURE(row);
    for (const std::string phase : {"before", "during"}) {
      CAPTURE(phase);
      CHECK(figure(testbed, "floods", row, phase + "_samples") > 0);
      CHECK(figure(testbed, "floods", row, phase + "_disconnects") == 0);
      CHECK(figure(testbed, "floods", row, phase + "_violations") == 0);
    }
  }
  for (const auto& [row, reason] : {std::pair{"Hello, 2 address(es)", "unexpected_message"},
                                    {"ClientAuth, 2 address(es)", "not_authenticated"},
                                    {"Ping, 2 address(es)", "still connected"}}) {
    CAPTURE(row);
    const std::set<std::string> told = endings(testbed, "floods", row);
    CHECK_FALSE(told.empty());
    for (const std::string& ending : told) {
      CAPTURE(ending);
      CHECK((ending == reason || ending == "still connected" || ending == "closed without a word"));
    }
  }
  CHECK(testbed["bars"].size() == 3);
}

TEST_CASE("a siege has quiet windows and windows under attack", "[testbed]") {
  std::string tables;
  const json testbed = run_testbed({"--experiments", "siege", "--siege-bots", "3", "--attacks",
                                    "absurd-views", "--attackers", "2"},
                                   tables);
  for (const char* window : {"window 0 quiet", "window 1 absurd-views", "window 2 quiet"}) {
    CAPTURE(window);
    CHECK(figure(testbed, "siege", window, "samples") > 0);
    CHECK(figure(testbed, "siege", window, "never") <=
          0.2 * figure(testbed, "siege", window, "samples"));
    CHECK(figure(testbed, "siege", window, "disconnects") == 0);
    CHECK(figure(testbed, "siege", window, "rejected") == 0);
    CHECK(figure(testbed, "siege", window, "violations") == 0);
    CHECK(figure(testbed, "siege", window, "server_resident_mb") > 0);
  }
  CHECK(figure(testbed, "siege", "all", "stop_s") > 0);
  CHECK(figure(testbed, "siege", "all", "errors_logged") == 0);
  CHECK(testbed["bars"].size() == 3);
  CHECK(tables.find("| absurd-views |") != std::string::npos);
}

TEST_CASE("backups take turns with quiet windows and disturb nobody's connection", "[testbed]") {
  std::string tables;
  const json testbed = run_testbed({"--experiments", "backup", "--backup-mib", "2"}, tables);
  for (const char* window : {"0 quiet", "1 backups"}) {
    CAPTURE(window);
    CHECK(figure(testbed, "backup", window, "samples") > 0);
    CHECK(figure(testbed, "backup", window, "disconnects") == 0);
    CHECK(figure(testbed, "backup", window, "violations") == 0);
  }
  CHECK(figure(testbed, "backup", "0 quiet", "backups") == 0);
  CHECK(figure(testbed, "backup", "1 backups", "backups") > 0);
  CHECK(testbed["bars"].size() == 1);
}
#endif
