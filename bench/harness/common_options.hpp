// Options that several subcommands of runstone-bench have. `options` must outlive the parse.
#pragma once
#include <set>
#include <string>

#include "bench/harness/bench_options.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

/// Adds --worlds, which accepts names of `worlds`, and --luanti.
void add_world_options(CLI::App& command, BenchOptions& options,
                       const std::set<std::string>& worlds);
/// Adds --edges.
void add_edge_option(CLI::App& command, BenchOptions& options);
/// Adds --csv and --json.
void add_file_options(CLI::App& command, BenchOptions& options);
/// Adds an option for `options.repetitions`, 1 to 1000, with its present value as the default.
void add_repetitions_option(CLI::App& command, BenchOptions& options, const std::string& name,
                            const std::string& description);

}  // namespace runstone::bench
