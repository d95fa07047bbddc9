// ProgramOptions: the command line of runstone-bench.
#pragma once
#include <iosfwd>
#include <optional>

#include "bench/client/client_options.hpp"
#include "bench/frames/frames_options.hpp"
#include "bench/harness/bench_options.hpp"
#include "bench/network/net_options.hpp"
#include "bench/view/view_options.hpp"

namespace runstone::bench {

enum class Command {
  mesh,
  chunk_edge,
  mesh_once,
  edit_to_mesh,
  edits,
  log,
  stores,
  relay,
  fan_out,
  bytes,
  bytes_to_quads,
  veil,
  storage,
  tiles,
  voxelise,
  map,
  net,
  frames,
  view,
  client,
  scenario_facts,
  scenario_times,
  machine
};

struct ProgramOptions {
  Command command = Command::mesh;
  BenchOptions bench;         // of every command without an entry below
  NetOptions net;             // of Command::net
  FramesOptions frames;       // of Command::frames
  ViewOptions view;           // of Command::view
  ClientBenchOptions client;  // of Command::client
};

/// The options, or the exit code of a program that ends here: 0 after help, 2 after a mistake.
struct ParsedProgramOptions {
  std::optional<ProgramOptions> options;
  int exit_code = 0;
};

/// Parses the command line. Prints help to `out` and mistakes to `err`.
ParsedProgramOptions parse_program_options(int argc, const char* const* argv, std::ostream& out,
                                           std::ostream& err);

}  // namespace runstone::bench
