#include "tests/bench/app/bench_options.hpp"

#include <CLI/CLI.hpp>
#include <set>

#include "tests/bench/meshing/mesher_case.hpp"
#include "tests/bench/worlds/lit_chunk.hpp"
#include "tests/bench/worlds/measured_worlds.hpp"

namespace runstone::bench {
namespace {

constexpr const char* kSmallLuanti = RUNSTONE_SOURCE_DIR "/tests/data/luanti_v7_small";

std::set<std::string> meshers() {
  const auto names = mesher_case_names();
  return {names.begin(), names.end()};
}

}  // namespace

ParsedBenchOptions parse_bench_options(int argc, const char* const* argv, std::ostream& out,
                                       std::ostream& err) {
  BenchOptions options;
  options.luanti = options.net.luanti = options.frames.luanti = options.report.luanti =
      kSmallLuanti;
  bool quick = false;
  CLI::App app(
      "Measures meshing, storage, edits, the log, the network, frames, and prints tables of "
      "Markdown, or "
      "makes "
      "a page of them all.",
      "runstone-bench");
  app.require_subcommand(1);
  const auto worlds_of = [&](CLI::App* command, const std::set<std::string>& worlds) {
    command->add_option("--worlds", options.worlds, "worlds to measure; all by default")
        ->delimiter(',')
        ->check(CLI::IsMember(worlds));
    command->add_option("--luanti", options.luanti, "folder of a Luanti world")
        ->capture_default_str()
        ->check(CLI::ExistingDirectory);
  };
  const auto common = [&](CLI::App* command, const std::set<std::string>& worlds) {
    worlds_of(command, worlds);
    command->add_option("--edges", options.edges, "sides of the volumes, in voxels")
        ->delimiter(',')
        ->check(CLI::Range(8, 128));
  };
  const auto files = [&](CLI::App* command) {
    command->add_option("--csv", options.csv, "write all rows to this file");
    command->add_option("--json", options.json, "write all rows and the summary to this file");
  };
  CLI::App* mesh =
      app.add_subcommand("mesh", "meshers against each other: mesher x world x edge x axis order");
  common(mesh, measured_world_names());
  files(mesh);
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
  mesh->add_option("--min-runs", options.repetitions, "repetitions of each mesher in each cell")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  mesh->add_flag("--quick", quick,
                 "three repetitions, edge 16 and best orders, unless said otherwise");

  CLI::App* chunk_edge =
      app.add_subcommand("chunk-edge", "what the edge of world chunks costs and saves");
  common(chunk_edge, landscape_names());
  files(chunk_edge);

  CLI::App* edits = app.add_subcommand(
      "edits", "what edits cost: stacks, spheres, strokes, and the replay of a log");
  files(edits);
  edits->add_option("--min-runs", options.repetitions, "repetitions; a tenth of them of the replay")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  edits->add_option("--edits", options.edits, "length of the log that is replayed")
      ->capture_default_str()
      ->check(CLI::Range(100, 10'000'000));

  CLI::App* log =
      app.add_subcommand("log", "what a long log costs: questions, keyframes, moments of the past");
  std::size_t log_edits = 1'000'000;
  log->add_option("--edits", log_edits, "length of the log")
      ->capture_default_str()
      ->check(CLI::Range(100, 100'000'000));
  log->add_option("--min-runs", options.repetitions, "questions of each sort, and moments")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  log->add_option("--json", options.json, "write all figures to this file");

  CLI::App* bytes =
      app.add_subcommand("bytes", "forms to send a chunk in: bytes, and time both ways");
  unsigned bytes_repetitions = 9;
  const auto byte_worlds = byte_world_names();
  worlds_of(bytes, {byte_worlds.begin(), byte_worlds.end()});
  files(bytes);
  bytes->add_option("--min-runs", bytes_repetitions, "times that each chunk is coded in each form")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));

  CLI::App* storage =
      app.add_subcommand("storage", "ways to keep voxels: bytes, reads, walks, edits");
  common(storage, measured_world_names());
  files(storage);
  unsigned storage_repetitions = 15;
  storage->add_option("--min-runs", storage_repetitions, "repetitions of each store on each volume")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));

  CLI::App* mesh_once =
      app.add_subcommand("mesh-once", "one mesher, not timed: for tools that count");
  common(mesh_once, measured_world_names());
  unsigned times = 1;
  std::string mesher = "rdm";
  mesh_once->add_option("--mesher", mesher)->capture_default_str()->check(CLI::IsMember(meshers()));
  mesh_once->add_option("--times", times, "meshes of each volume")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  CLI::App* net = add_net_command(app, options.net);
  CLI::App* frames = add_frames_command(app, options.frames);
  CLI::App* report = add_report_command(app, options.report);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error, out, err) == 0 ? 0 : 2};
  }
  if (chunk_edge->parsed()) options.command = BenchOptions::Command::chunk_edge;
  if (edits->parsed()) options.command = BenchOptions::Command::edits;
  if (log->parsed()) {
    options.command = BenchOptions::Command::log;
    options.edits = log_edits;
  }
  if (net->parsed()) {
    options.command = BenchOptions::Command::net;
    finish_net_options(*net, options.net);
  }
  if (frames->parsed()) options.command = BenchOptions::Command::frames;
  if (report->parsed()) options.command = BenchOptions::Command::report;
  if (bytes->parsed()) {
    options.command = BenchOptions::Command::bytes;
    options.repetitions = bytes_repetitions;
  }
  if (storage->parsed()) {
    options.command = BenchOptions::Command::storage;
    options.repetitions = storage_repetitions;
  }
  if (mesh_once->parsed()) {
    options.command = BenchOptions::Command::mesh_once;
    options.meshers = {mesher};
    options.repetitions = times;
  }
  if (quick) {
    if (mesh->count("--min-runs") == 0) options.repetitions = 3;
    if (mesh->count("--edges") == 0) options.edges = {16};
    if (mesh->count("--orders") == 0) options.orders = {"best"};
  }
  if (options.edges.empty()) {
    const bool powers = chunk_edge->parsed() || storage->parsed();
    options.edges = powers ? std::vector<unsigned>{16, 32, 64} : std::vector<unsigned>{32, 62};
  }
  return {options, 0};
}

}  // namespace runstone::bench
