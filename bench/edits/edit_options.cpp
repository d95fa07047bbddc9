#include "bench/edits/edit_options.hpp"

#include <CLI/CLI.hpp>

#include "bench/harness/common_options.hpp"

namespace runstone::bench {

CLI::App* add_edits_command(CLI::App& app, BenchOptions& options) {
  CLI::App* edits = app.add_subcommand(
      "edits", "the costs of edits: stacks, spheres, strokes, and the replay of a log");
  add_file_options(*edits, options);
  add_repetitions_option(*edits, options, "--min-runs",
                         "repetitions; a tenth of them of the replay");
  edits->add_option("--edits", options.edits, "length of the log that is replayed")
      ->capture_default_str()
      ->check(CLI::Range(100, 10'000'000));
  return edits;
}

CLI::App* add_log_command(CLI::App& app, BenchOptions& options) {
  options.edits = 1'000'000;
  CLI::App* log = app.add_subcommand(
      "log",
      "the costs of a long log: questions, keyframes, moments of the past, previews of rollbacks");
  log->add_option("--edits", options.edits, "length of the log")
      ->capture_default_str()
      ->check(CLI::Range(100, 100'000'000));
  add_repetitions_option(*log, options, "--min-runs",
                         "questions of each sort, moments, and previews");
  log->add_option("--json", options.json, "write all figures to this file");
  return log;
}

CLI::App* add_stores_command(CLI::App& app, BenchOptions& options) {
  CLI::App* stores =
      app.add_subcommand("stores", "durable edits in a world on SQLite and in one on PostgreSQL");
  stores->add_option("--postgres", options.postgres, "address of a database: postgresql://...")
      ->required();
  add_repetitions_option(*stores, options, "--min-runs", "commits of each size and database");
  stores->add_option("--json", options.json, "write all figures to this file");
  return stores;
}

}  // namespace runstone::bench
