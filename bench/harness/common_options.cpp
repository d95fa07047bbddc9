#include "bench/harness/common_options.hpp"

#include <CLI/CLI.hpp>

namespace runstone::bench {

void add_world_options(CLI::App& command, BenchOptions& options,
                       const std::set<std::string>& worlds) {
  command.add_option("--worlds", options.worlds, "worlds to measure; all by default")
      ->delimiter(',')
      ->check(CLI::IsMember(worlds));
  command.add_option("--luanti", options.luanti, "folder of a Luanti world")
      ->capture_default_str()
      ->check(CLI::ExistingDirectory);
}

void add_edge_option(CLI::App& command, BenchOptions& options) {
  command.add_option("--edges", options.edges, "sides of the volumes, in voxels")
      ->delimiter(',')
      ->check(CLI::Range(8, 128));
}

void add_file_options(CLI::App& command, BenchOptions& options) {
  command.add_option("--csv", options.csv, "write all rows to this file");
  command.add_option("--json", options.json, "write all rows and the summary to this file");
}

void add_repetitions_option(CLI::App& command, BenchOptions& options, const std::string& name,
                            const std::string& description) {
  command.add_option(name, options.repetitions, description)
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
}

}  // namespace runstone::bench
