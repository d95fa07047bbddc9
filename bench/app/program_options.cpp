#include "bench/app/program_options.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <string>

#include "bench/edits/edit_options.hpp"
#include "bench/map/map_options.hpp"
#include "bench/meshing/mesh_options.hpp"
#include "bench/servers/server_options.hpp"
#include "bench/storage/storage_options.hpp"
#include "bench/thesis/scenario_bench.hpp"
#include "bench/tiles/tiles_options.hpp"
#include "bench/voxelise/voxelise_options.hpp"
#include "bench/wire/bytes_options.hpp"
#include "common/core/version.hpp"

namespace runstone::bench {
namespace {

CLI::App* add_machine_command(CLI::App& app, BenchOptions& options) {
  CLI::App* machine = app.add_subcommand(
      "machine",
      "measures nothing: prints the processor, compiler, commit and vector instructions");
  machine->add_option("--json", options.json, "write them to this file");
  return machine;
}

constexpr const char* kSmallLuanti = RUNSTONE_SOURCE_DIR "/tests/data/luanti_v7_small";

struct Subcommand {
  Command command;
  CLI::App* (*add)(CLI::App&, BenchOptions&);
};
/// The subcommands whose options are BenchOptions.
constexpr std::array<Subcommand, 19> kSubcommands = {
    {{Command::mesh, add_mesh_command},
     {Command::chunk_edge, add_chunk_edge_command},
     {Command::edits, add_edits_command},
     {Command::log, add_log_command},
     {Command::stores, add_stores_command},
     {Command::relay, add_relay_command},
     {Command::fan_out, add_fan_out_command},
     {Command::bytes, add_bytes_command},
     {Command::bytes_to_quads, add_bytes_to_quads_command},
     {Command::veil, add_veil_command},
     {Command::storage, add_storage_command},
     {Command::tiles, add_tiles_command},
     {Command::voxelise, add_voxelise_command},
     {Command::map, add_map_command},
     {Command::mesh_once, add_mesh_once_command},
     {Command::edit_to_mesh, add_edit_to_mesh_command},
     {Command::scenario_facts, add_scenario_facts_command},
     {Command::scenario_times, add_scenario_times_command},
     {Command::machine, add_machine_command}}};

}  // namespace

ParsedProgramOptions parse_program_options(int argc, const char* const* argv, std::ostream& out,
                                           std::ostream& err) {
  CLI::App app(
      "Measures meshing, storage, edits, the log, the network and frames, "
      "and prints tables of Markdown.",
      "runstone-bench");
  app.require_subcommand(1);
  app.set_version_flag("--version", "runstone-bench " + std::string(version()));
  ProgramOptions options;
  options.net.luanti = options.frames.luanti = kSmallLuanti;
  options.view.luanti = options.client.luanti = kSmallLuanti;
  // Each subcommand has defaults of its own.
  std::array<BenchOptions, kSubcommands.size()> bench;
  std::array<const CLI::App*, kSubcommands.size()> parsers{};
  for (std::size_t i = 0; i < kSubcommands.size(); ++i) {
    bench[i].luanti = kSmallLuanti;
    parsers[i] = kSubcommands[i].add(app, bench[i]);
  }
  const CLI::App* net = add_net_command(app, options.net);
  const CLI::App* frames = add_frames_command(app, options.frames);
  const CLI::App* view = add_view_command(app, options.view);
  const CLI::App* client = add_client_command(app, options.client);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error, out, err) == 0 ? 0 : 2};
  }
  if (net->parsed()) options.command = Command::net;
  if (frames->parsed()) options.command = Command::frames;
  if (client->parsed()) options.command = Command::client;
  if (view->parsed()) options.command = Command::view;
  for (std::size_t i = 0; i < kSubcommands.size(); ++i) {
    if (!parsers[i]->parsed()) continue;
    options.command = kSubcommands[i].command;
    options.bench = std::move(bench[i]);
  }
  return {std::move(options), 0};
}

}  // namespace runstone::bench
