#include "bench/storage/storage_options.hpp"

#include <CLI/CLI.hpp>

#include "bench/harness/common_options.hpp"
#include "bench/worlds/measured_worlds.hpp"

namespace runstone::bench {

CLI::App* add_storage_command(CLI::App& app, BenchOptions& options) {
  options.edges = {16, 32, 64};
  options.repetitions = 15;
  CLI::App* storage =
      app.add_subcommand("storage", "ways to store voxels: bytes, reads, walks, edits");
  add_world_options(*storage, options, measured_world_names());
  add_edge_option(*storage, options);
  add_file_options(*storage, options);
  add_repetitions_option(*storage, options, "--min-runs",
                         "repetitions of each store on each volume");
  return storage;
}

}  // namespace runstone::bench
