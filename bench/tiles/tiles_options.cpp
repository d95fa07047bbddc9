#include "bench/tiles/tiles_options.hpp"

#include <CLI/CLI.hpp>

#include "bench/harness/common_options.hpp"
#include "bench/worlds/measured_worlds.hpp"

namespace runstone::bench {

CLI::App* add_tiles_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 9;
  options.edges = {32};
  const auto worlds = landscape_names();
  options.worlds = {worlds.begin(), worlds.end()};
  CLI::App* tiles = app.add_subcommand(
      "tiles", "levels of detail: runs, bytes, and the times to build, decode and mesh them");
  add_world_options(*tiles, options, worlds);
  tiles->add_option("--edges", options.edges, "edges of the chunks, in voxels")
      ->delimiter(',')
      ->check(CLI::IsMember({16, 32, 64, 128}));
  tiles->add_option("--json", options.json, "write all rows to this file");
  add_repetitions_option(*tiles, options, "--min-runs", "passes over the tiles of a level");
  return tiles;
}

}  // namespace runstone::bench
