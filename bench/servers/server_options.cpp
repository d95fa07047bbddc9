#include "bench/servers/server_options.hpp"

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

CLI::App* add_fan_out_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 20;
  CLI::App* fan_out = app.add_subcommand(
      "fan-out", "what one commit to many clients costs, beside a loop of system calls");
  add_repetitions_option(*fan_out, options, "--min-runs", "rounds of each of five blocks");
  fan_out->add_option("--clients", options.clients, "receivers of each sender")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  fan_out->add_option("--json", options.json, "write all figures to this file");
  return fan_out;
}

}  // namespace runstone::bench
