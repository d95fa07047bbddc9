#include "bench/voxelise/voxelise_options.hpp"

#include <CLI/CLI.hpp>

#include "bench/harness/common_options.hpp"

namespace runstone::bench {

CLI::App* add_voxelise_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 5;
  options.edges = {128, 256, 512, 1024};
  options.triangles = {10'000, 100'000, 1'000'000};
  CLI::App* voxelise = app.add_subcommand(
      "voxelise", "meshes of triangles into runs, and into a grid of one byte a voxel");
  voxelise->add_option("--edges", options.edges, "longest sides of the results, in voxels")
      ->delimiter(',')
      ->check(CLI::Range(16U, 4096U));
  voxelise->add_option("--triangles", options.triangles, "triangles of the statues, about")
      ->delimiter(',')
      ->check(CLI::Range(100, 10'000'000));
  voxelise->add_option("--json", options.json, "write all rows to this file");
  add_repetitions_option(*voxelise, options, "--min-runs", "measurements of each case");
  return voxelise;
}

}  // namespace runstone::bench
