// The command lines of `runstone-bench mesh`, `chunk-edge`, `mesh-once` and `edit-to-mesh`.
#pragma once
#include "bench/harness/bench_options.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

/// Each function adds its subcommand with its defaults. `options` must outlive the parse.
CLI::App* add_mesh_command(CLI::App& app, BenchOptions& options);
CLI::App* add_chunk_edge_command(CLI::App& app, BenchOptions& options);
CLI::App* add_mesh_once_command(CLI::App& app, BenchOptions& options);
CLI::App* add_edit_to_mesh_command(CLI::App& app, BenchOptions& options);

}  // namespace runstone::bench
