// `runstone-bench mesh`: every mesher on every volume, and what that says about the bars.
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "tests/bench/app/bench_options.hpp"
#include "tests/bench/meshing/mesh_result.hpp"

namespace runstone::bench {

/// Progress goes to `progress`, a line a world and edge. Fails if a world cannot be read.
Result<MeshResult, std::string> run_mesh_bench(const BenchOptions& options, std::ostream& progress);

}  // namespace runstone::bench
