// `runstone-bench bytes-to-quads`: from the bytes of a chunk on the wire to its quads, stage by stage, as a
// joining client does it, and the same from dense voxels and binary greedy meshing. All chunks of a
// world are done in turn, once a pass, so that caches and branch predictors are as cold as in a
// client.
#pragma once
#include <array>
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "tests/bench/harness/bench_options.hpp"
#include "tests/bench/harness/machine.hpp"
#include "tests/bench/harness/target.hpp"

namespace runstone::bench {

/// One way over the chunks of a world that are not uniform. A chunk's time of a stage is its median
/// over the passes.
struct QuadsWay {
  std::string name;  // "runs" or "dense"
  double bytes = 0;  // mean of a chunk
  /// Means of a chunk, in µs:
  ///   - runs: unpacked and validated runs; nothing; mesh, with the borders that earlier meshes left;
  ///   - dense: unpacked palette ids; the grid with its border and the mask; mesh.
  std::array<double, 3> stage_us{};
  std::vector<double> total_us;  // by chunk
  double total() const { return stage_us[0] + stage_us[1] + stage_us[2]; }
};

struct QuadsRow {
  std::string world;
  unsigned edge = 0;
  std::size_t chunks = 0;
  QuadsWay runs, dense;
  double gain_mean = 0, gain_sums = 0;  // dense / runs: geometric mean, ratio of sums
};

struct QuadsResult {
  Machine machine;
  unsigned repetitions = 0;
  std::vector<QuadsRow> rows;
  std::vector<Target> targets() const;
};

/// Fails if the Luanti world cannot be read. Aborts if a chunk does not come back as it was.
Result<QuadsResult, std::string> run_bytes_to_quads(const BenchOptions& options,
                                                    std::ostream& progress);

void write_table(const QuadsResult& result, std::ostream& out);
void write_json(const QuadsResult& result, std::ostream& out);

}  // namespace runstone::bench
