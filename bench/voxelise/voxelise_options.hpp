// The command line of `runstone-bench voxelise`.
#pragma once
#include "bench/harness/bench_options.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

/// Adds the subcommand with its defaults. `options` must outlive the parse.
CLI::App* add_voxelise_command(CLI::App& app, BenchOptions& options);

}  // namespace runstone::bench
