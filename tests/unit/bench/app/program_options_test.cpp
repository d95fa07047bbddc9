#include "bench/app/program_options.hpp"

#include <catch2/catch.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace runstone::bench {
namespace {

using Edges = std::vector<unsigned>;
using Names = std::vector<std::string>;

ParsedProgramOptions parse(std::vector<const char*> words) {
  words.insert(words.begin(), "runstone-bench");
  std::ostringstream out, err;
  return parse_program_options(static_cast<int>(words.size()), words.data(), out, err);
}

ProgramOptions options_of(const std::vector<const char*>& words) {
  const ParsedProgramOptions parsed = parse(words);
  REQUIRE(parsed.options);
  return *parsed.options;
}

TEST_CASE("each subcommand of runstone-bench has defaults of its own", "[options]") {
  const ProgramOptions mesh = options_of({"mesh"});
  CHECK(mesh.command == Command::mesh);
  CHECK(mesh.bench.edges == Edges{32, 62});
  CHECK(mesh.bench.repetitions == 30);
  CHECK(mesh.bench.orders == Names{"best", "worst"});

  const ProgramOptions chunk_edge = options_of({"chunk-edge"});
  CHECK(chunk_edge.command == Command::chunk_edge);
  CHECK(chunk_edge.bench.edges == Edges{16, 32, 64});

  const ProgramOptions edit_to_mesh = options_of({"edit-to-mesh"});
  CHECK(edit_to_mesh.command == Command::edit_to_mesh);
  CHECK(edit_to_mesh.bench.edges == Edges{32, 64});
  CHECK(edit_to_mesh.bench.repetitions == 60);

  const ProgramOptions mesh_once = options_of({"mesh-once"});
  CHECK(mesh_once.command == Command::mesh_once);
  CHECK(mesh_once.bench.meshers == Names{"rdm"});
  CHECK(mesh_once.bench.repetitions == 1);

  const ProgramOptions edits = options_of({"edits"});
  CHECK(edits.command == Command::edits);
  CHECK(edits.bench.edits == 200'000);
  CHECK(edits.bench.repetitions == 30);

  const ProgramOptions log = options_of({"log"});
  CHECK(log.command == Command::log);
  CHECK(log.bench.edits == 1'000'000);

  const ProgramOptions voxelise = options_of({"voxelise"});
  CHECK(voxelise.command == Command::voxelise);
  CHECK(voxelise.bench.edges == Edges{128, 256, 512, 1024});
  CHECK(voxelise.bench.repetitions == 5);

  const ProgramOptions bytes = options_of({"bytes"});
  CHECK(bytes.command == Command::bytes);
  CHECK(bytes.bench.repetitions == 9);

  const ProgramOptions storage = options_of({"storage"});
  CHECK(storage.command == Command::storage);
  CHECK(storage.bench.edges == Edges{16, 32, 64});
  CHECK(storage.bench.repetitions == 15);

  CHECK(options_of({"net"}).command == Command::net);
  CHECK(options_of({"frames"}).command == Command::frames);
  CHECK(options_of({"view"}).command == Command::view);
  CHECK(options_of({"client"}).command == Command::client);
  CHECK(options_of({"machine"}).command == Command::machine);
  CHECK(options_of({"scenario-facts"}).command == Command::scenario_facts);

  const ProgramOptions times = options_of({"scenario-times"});
  CHECK(times.command == Command::scenario_times);
  CHECK(times.bench.repetitions == 9);
}

TEST_CASE("the option --quick changes only what the command line does not name", "[options]") {
  const ProgramOptions mesh = options_of({"mesh", "--quick"});
  CHECK(mesh.bench.repetitions == 3);
  CHECK(mesh.bench.edges == Edges{16});
  CHECK(mesh.bench.orders == Names{"best"});
  const ProgramOptions named =
      options_of({"mesh", "--quick", "--edges", "32", "--orders", "all", "--min-runs", "7"});
  CHECK(named.bench.repetitions == 7);
  CHECK(named.bench.edges == Edges{32});
  CHECK(named.bench.orders == Names{"all"});

  const ProgramOptions net = options_of({"net", "--quick", "--clients", "5"});
  CHECK(net.net.edits == 100);
  CHECK(net.net.repetitions == 1);
  CHECK(net.net.clients == Edges{5});
  CHECK(net.net.fleet_seconds == 3);
  CHECK(options_of({"net"}).net.edits == 1000);
}

TEST_CASE("help ends with exit code 0, a mistake with 2", "[options]") {
  CHECK(parse({"--help"}).exit_code == 0);
  CHECK_FALSE(parse({"mesh", "--help"}).options);
  const std::vector<std::vector<const char*>> mistakes = {{},
                                                          {"unknown"},
                                                          {"mesh", "--edges", "7"},
                                                          {"mesh", "--meshers", "unknown"},
                                                          {"bytes", "--worlds", "unknown"},
                                                          {"log", "--csv", "x"}};
  for (const auto& words : mistakes) {
    const ParsedProgramOptions parsed = parse(words);
    CHECK_FALSE(parsed.options);
    CHECK(parsed.exit_code == 2);
  }
}

}  // namespace
}  // namespace runstone::bench
