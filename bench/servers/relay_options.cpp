#include "bench/servers/relay_options.hpp"

#include <CLI/CLI.hpp>

#include "bench/harness/common_options.hpp"

namespace runstone::bench {

CLI::App* add_relay_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 9;
  CLI::App* relay = app.add_subcommand(
      "relay", "what an edit costs at two servers of one world, without sockets and database");
  add_repetitions_option(*relay, options, "--min-runs", "repetitions");
  relay->add_option("--json", options.json, "write all figures to this file");
  return relay;
}

}  // namespace runstone::bench
