// `runstone-bench mesh`: every mesher on every volume, and the targets of meshing.
#pragma once
#include <iosfwd>
#include <string>

#include "bench/harness/bench_options.hpp"
#include "bench/meshing/mesh_result.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Prints a line of progress for each world and edge. Fails if a world cannot be read.
Result<MeshResult, std::string> run_mesh_bench(const BenchOptions& options, std::ostream& progress);

}  // namespace runstone::bench
