// The command line of `runstone-bench fan-out`.
#pragma once
#include "bench/harness/bench_options.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

/// Adds the subcommand with its defaults. `options` must outlive the parse.
CLI::App* add_fan_out_command(CLI::App& app, BenchOptions& options);

}  // namespace runstone::bench
