#include "bench/meshing/mesh_options.hpp"

#include <CLI/CLI.hpp>
#include <set>
#include <string>

#include "bench/harness/common_options.hpp"
#include "bench/meshing/mesher_case.hpp"
#include "bench/worlds/measured_worlds.hpp"

namespace runstone::bench {
namespace {

std::set<std::string> meshers() {
  const auto names = mesher_case_names();
  return {names.begin(), names.end()};
}

}  // namespace

CLI::App* add_mesh_command(CLI::App& app, BenchOptions& options) {
  options.edges = {32, 62};
  CLI::App* mesh =
      app.add_subcommand("mesh", "meshers against each other: mesher x world x edge x axis order");
  add_world_options(*mesh, options, measured_world_names());
  add_edge_option(*mesh, options);
  add_file_options(*mesh, options);
  mesh->add_option("--meshers", options.meshers, "meshers to measure; all by default")
      ->delimiter(',')
      ->check(CLI::IsMember(meshers()));
  mesh->add_option("--parts", options.parts,
                   "volumes to measure, by name: scenario 17 is \"17\"; all by default")
      ->delimiter(',');
  mesh->add_option("--orders", options.orders, "axis orders of the chunk, by their runs")
      ->capture_default_str()
      ->delimiter(',')
      ->check(CLI::IsMember(std::set<std::string>{"best", "worst", "all"}));
  add_repetitions_option(*mesh, options, "--min-runs", "repetitions of each mesher in each cell");
  mesh->add_flag("--quick")->description(
      "three repetitions, edge 16 and best orders, unless said otherwise");
  mesh->callback([mesh, &options] {
    if (mesh->count("--quick") == 0) return;
    if (mesh->count("--min-runs") == 0) options.repetitions = 3;
    if (mesh->count("--edges") == 0) options.edges = {16};
    if (mesh->count("--orders") == 0) options.orders = {"best"};
  });
  return mesh;
}

CLI::App* add_chunk_edge_command(CLI::App& app, BenchOptions& options) {
  options.edges = {16, 32, 64};
  CLI::App* chunk_edge =
      app.add_subcommand("chunk-edge", "the costs and savings of each edge of world chunks");
  add_world_options(*chunk_edge, options, landscape_names());
  add_edge_option(*chunk_edge, options);
  add_file_options(*chunk_edge, options);
  return chunk_edge;
}

CLI::App* add_mesh_once_command(CLI::App& app, BenchOptions& options) {
  options.edges = {32, 62};
  options.meshers = {"rdm"};
  options.repetitions = 1;
  CLI::App* mesh_once =
      app.add_subcommand("mesh-once", "one mesher, not timed: for tools that count");
  add_world_options(*mesh_once, options, measured_world_names());
  add_edge_option(*mesh_once, options);
  mesh_once->add_option("--mesher", options.meshers.front(), "mesher to run")
      ->capture_default_str()
      ->check(CLI::IsMember(meshers()));
  add_repetitions_option(*mesh_once, options, "--times", "meshes of each volume");
  return mesh_once;
}

CLI::App* add_edit_to_mesh_command(CLI::App& app, BenchOptions& options) {
  options.edges = {32, 64};
  options.worlds = {"hills", "caves", "town", "luanti"};
  options.repetitions = 60;
  CLI::App* edit_to_mesh =
      app.add_subcommand("edit-to-mesh", "edits by brush: layers meshed again, or the whole chunk");
  add_world_options(*edit_to_mesh, options, landscape_names());
  add_edge_option(*edit_to_mesh, options);
  add_file_options(*edit_to_mesh, options);
  add_repetitions_option(*edit_to_mesh, options, "--min-runs", "edits of each brush in a volume");
  return edit_to_mesh;
}

}  // namespace runstone::bench
