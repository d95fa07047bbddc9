// `runstone-bench mesh-once`: one mesher over the volumes of the worlds asked for, with nothing timed, for
// tools that count what happens inside (scripts/callgrind-mesh).
#pragma once
#include <iosfwd>
#include <span>
#include <string>

#include "common/core/result.hpp"
#include "tests/bench/app/bench_options.hpp"
#include "tests/bench/meshing/mesher_case.hpp"

namespace runstone::bench {

/// Meshes every mesher_case `times` times. Never inlined: a tool that counts starts and stops at this name.
[[gnu::noinline]] void mesh_counted(std::span<MesherCase> mesher_cases, unsigned times);

/// Warms every mesher_case up, calls mesh_counted() once a world and edge, and prints a line of JSON for each:
/// world, edge, mesher, simd, and over all its volumes the meshes made, and the volumes, runs and quads.
/// Volumes are in their cheapest axis order. Fails if a world cannot be read or has no volume for the mesher.
Result<void, std::string> run_mesh_once(const BenchOptions& options, std::ostream& out);

}  // namespace runstone::bench
