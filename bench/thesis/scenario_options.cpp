#include <CLI/CLI.hpp>

#include "bench/harness/common_options.hpp"
#include "bench/thesis/scenario_bench.hpp"

namespace runstone::bench {

CLI::App* add_scenario_facts_command(CLI::App& app, BenchOptions& options) {
  CLI::App* facts = app.add_subcommand(
      "scenario-facts", "voxels, runs and bytes of the thesis' 37 scenarios, all 27 chunks");
  facts->add_option("--json", options.json, "write all rows to this file");
  return facts;
}

CLI::App* add_scenario_times_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 9;
  CLI::App* times = app.add_subcommand(
      "scenario-times", "the thesis' meshers on the thesis' 37 scenarios, all 27 chunks");
  times->add_option("--json", options.json, "write all rows to this file");
  add_repetitions_option(*times, options, "--min-runs", "repetitions of each mesher on each chunk");
  return times;
}

}  // namespace runstone::bench
