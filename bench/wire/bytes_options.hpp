// The command lines of `runstone-bench bytes`, `bytes-to-quads` and `veil`.
#pragma once
#include "bench/harness/bench_options.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

/// Add a subcommand with its defaults. `options` must outlive the parse.
CLI::App* add_bytes_command(CLI::App& app, BenchOptions& options);
CLI::App* add_bytes_to_quads_command(CLI::App& app, BenchOptions& options);
CLI::App* add_veil_command(CLI::App& app, BenchOptions& options);

}  // namespace runstone::bench
