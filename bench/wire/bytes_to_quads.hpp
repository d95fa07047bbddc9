// `runstone-bench bytes-to-quads`: from the bytes of a chunk on the wire to its quads, stage by
// stage, as a joining client does it; and the same from dense voxels by binary greedy meshing. A
// pass does all chunks of a world in turn, so caches and branch predictors are as cold as in a
// client.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/target.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// One way over the chunks of a world that are not uniform. A chunk's time of a stage is its median
/// over the passes. Times are means over the chunks.
struct QuadsWay {
  double bytes = 0;              // mean of a chunk
  double unpack_us = 0;          // to validated runs, or to palette ids
  double grid_us = 0;            // the grid with its border and the mask; 0 for runs
  double mesh_us = 0;            // of runs: with the borders that earlier meshes left
  std::vector<double> total_us;  // by chunk
  double mean_us() const { return unpack_us + grid_us + mesh_us; }
};

struct QuadsRow {
  std::string world;
  unsigned edge = 0;
  std::size_t chunks = 0;
  std::size_t left_out = 0;  // more than 256 materials, there or in a neighbour
  QuadsWay runs, dense;
  double gain_mean = 0, gain_sums = 0;  // dense / runs: geometric mean, ratio of sums
};

struct QuadsResult {
  Machine machine;
  unsigned repetitions = 0;
  std::vector<QuadsRow> rows;
  std::vector<Target> targets() const;
};

/// Leaves out chunks with sides above 64, which binary greedy cannot mesh, and prints that to
/// `progress`.
/// Fails if the Luanti world cannot be read. Aborts if a chunk does not come back as it was.
Result<QuadsResult, std::string> run_bytes_to_quads(const BenchOptions& options,
                                                    std::ostream& progress);

void write_table(const QuadsResult& result, std::ostream& out);
void write_json(const QuadsResult& result, std::ostream& out);

}  // namespace runstone::bench
