// The command lines of `runstone-bench relay` and `fan-out`.
#pragma once
#include "bench/harness/bench_options.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

/// Each adds its subcommand with its defaults. `options` must outlive the parse.
CLI::App* add_relay_command(CLI::App& app, BenchOptions& options);
CLI::App* add_fan_out_command(CLI::App& app, BenchOptions& options);

}  // namespace runstone::bench
