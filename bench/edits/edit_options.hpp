// The command lines of `runstone-bench edits`, `log` and `stores`.
#pragma once
#include "bench/harness/bench_options.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

/// Each function adds its subcommand with its defaults. `options` must outlive the parse.
CLI::App* add_edits_command(CLI::App& app, BenchOptions& options);
CLI::App* add_log_command(CLI::App& app, BenchOptions& options);
CLI::App* add_stores_command(CLI::App& app, BenchOptions& options);

}  // namespace runstone::bench
