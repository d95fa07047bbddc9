// `runstone-bench mesh-once`: one mesher over the volumes of the wanted worlds, without timing, for
// tools that count instructions (scripts/callgrind-mesh).
#pragma once
#include <iosfwd>
#include <span>
#include <string>

#include "bench/harness/bench_options.hpp"
#include "bench/meshing/mesher_case.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Meshes every mesher case `times` times. It is never inlined, because a counting tool starts and
/// stops at this name.
[[gnu::noinline]] void mesh_counted(std::span<MesherCase> mesher_cases, unsigned times);

/// Warms every mesher case up and calls mesh_counted() once for each world and edge. Prints a line
/// of JSON for each: world, edge, mesher, simd, and over all volumes the numbers of meshes,
/// volumes, runs and quads. Volumes are in their cheapest axis order. Fails if a world cannot be
/// read or has no volume for the mesher.
Result<void, std::string> run_mesh_once(const BenchOptions& options, std::ostream& out);

}  // namespace runstone::bench
