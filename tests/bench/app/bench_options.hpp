// BenchOptions: what the command line of runstone-bench says.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/frames/frames_options.hpp"
#include "tests/bench/network/net_options.hpp"
#include "tests/bench/report/report_options.hpp"

namespace runstone::bench {

struct BenchOptions {
  enum class Command {
    mesh,
    chunk_edge,
    mesh_once,
    edits,
    log,
    net,
    bytes,
    frames,
    storage,
    report
  };
  Command command = Command::mesh;
  std::vector<std::string> worlds;   // empty: all
  std::vector<std::string> parts;    // volumes by name; empty: all
  std::vector<std::string> meshers;  // mesher_cases; empty: all
  std::vector<unsigned> edges;
  std::vector<std::string> orders = {"best", "worst"};  // or "all"
  std::string luanti;                                   // folder of a world
  std::string csv, json;                                // files; empty: none
  unsigned repetitions = 30;
  std::size_t edits = 200'000;  // of the log that is replayed, or asked
  NetOptions net;               // of Command::net
  FramesOptions frames;         // of Command::frames
  ReportOptions report;         // of Command::report
};

/// The options, or the exit code of a program that has nothing more to do: 0 after help, 2 after a mistake.
/// Both were printed, to `out` and `err`.
struct ParsedBenchOptions {
  std::optional<BenchOptions> options;
  int exit_code = 0;
};
ParsedBenchOptions parse_bench_options(int argc, const char* const* argv, std::ostream& out,
                                       std::ostream& err);

}  // namespace runstone::bench
