#include "bench/map/map_options.hpp"

#include <CLI/CLI.hpp>

#include "bench/harness/common_options.hpp"

namespace runstone::bench {

CLI::App* add_map_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 15;
  options.edits = 200'000;
  CLI::App* map = app.add_subcommand(
      "map", "the map of the gateway: tiles of the present and the past, and a whole world");
  map->add_option("--luanti", options.luanti, "folder of a Luanti world")
      ->check(CLI::ExistingDirectory);
  map->add_option("--edits", options.edits, "length of the log")
      ->check(CLI::Range(std::size_t{1'000}, std::size_t{100'000'000}));
  map->add_option("--json", options.json, "write the figures to this file");
  add_repetitions_option(*map, options, "--min-runs", "tiles of each sort");
  return map;
}

}  // namespace runstone::bench
