// `runstone-bench voxelise`: statues of 10^4 to 10^6 triangles into runs, by the voxeliser and by
// way of a grid of one byte a voxel. The results of both are compared, and voxels of all ways with
// the oracle of the tests.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/target.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// One way on one mesh at one size. Times are medians of the thread's processor time.
struct VoxeliseRow {
  std::string way;  // "solid", "solid, byte grid", "surface", ...
  std::size_t triangles = 0;
  unsigned side = 0;  // longest side of the result, in voxels
  double cpu_s = 0, wall_s = 0;
  std::uint64_t model_bytes = 0;
  std::uint64_t peak_bytes = 0;  // besides the model; the pieces are dropped as they come
  std::uint64_t voxels = 0, runs = 0, run_bytes = 0;
  std::size_t compared = 0;   // voxels that were compared with the oracle (OracleSample)
  std::size_t differing = 0;  // of these
};

struct VoxeliseResult {
  Machine machine;
  unsigned repetitions = 0;
  std::vector<VoxeliseRow> rows;
  /// Returns the targets, if the statue of a million triangles was measured at a side of 1,024.
  std::vector<Target> targets() const;
};

/// Single-threaded. Fails if runs and byte grid differ in one voxel.
Result<VoxeliseResult, std::string> run_voxelise_bench(const BenchOptions& options,
                                                       std::ostream& progress);

void write_table(const VoxeliseResult& result, std::ostream& out);
void write_json(const VoxeliseResult& result, std::ostream& out);

}  // namespace runstone::bench
