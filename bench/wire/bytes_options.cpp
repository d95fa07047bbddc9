#include "bench/wire/bytes_options.hpp"

#include <CLI/CLI.hpp>

#include "bench/harness/common_options.hpp"
#include "bench/worlds/lit_chunk.hpp"
#include "bench/worlds/measured_worlds.hpp"

namespace runstone::bench {

CLI::App* add_bytes_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 9;
  CLI::App* bytes =
      app.add_subcommand("bytes", "forms to send a chunk in: bytes, and time both ways");
  const auto worlds = byte_world_names();
  add_world_options(*bytes, options, {worlds.begin(), worlds.end()});
  add_file_options(*bytes, options);
  add_repetitions_option(*bytes, options, "--min-runs",
                         "times that each chunk is coded in each form");
  return bytes;
}

CLI::App* add_bytes_to_quads_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 15;
  options.worlds = {"luanti"};
  options.edges = {32};
  CLI::App* quads = app.add_subcommand(
      "bytes-to-quads",
      "from the bytes of a chunk to its quads, stage by stage, against dense voxels");
  add_world_options(*quads, options, measured_world_names());
  add_edge_option(*quads, options);
  quads->add_option("--json", options.json, "write all rows to this file");
  add_repetitions_option(*quads, options, "--min-runs", "passes over the chunks of a world");
  return quads;
}

CLI::App* add_veil_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 9;
  options.edges = {32};
  const auto worlds = landscape_names();
  options.worlds = {worlds.begin(), worlds.end()};
  CLI::App* veil = app.add_subcommand(
      "veil", "chunks with and without what nobody can see: runs, bytes, unpacking and meshing");
  add_world_options(*veil, options, measured_world_names());
  add_edge_option(*veil, options);
  veil->add_option("--json", options.json, "write all rows to this file");
  add_repetitions_option(*veil, options, "--min-runs", "passes over the chunks of a world");
  return veil;
}

}  // namespace runstone::bench
