// `runstone-bench bytes`: the cost of sending the same voxels in each form: bytes, and the time to
// encode and decode.
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

/// Means over chunks of edge 32. A chunk's time is its median over the repetitions.
struct BytesRow {
  std::string world, form;
  bool mixed = false;  // only the chunks of more than one material
  std::size_t chunks = 0;
  double bytes = 0;
  double of_luanti = 0;       // ratio of sums against luanti_light
  double of_luanti_mean = 0;  // geometric mean of the chunks' ratios
  double of_minecraft = 0;    // ratio of sums
  double encode_us = 0, decode_us = 0;
};

struct BytesBench {
  Machine machine;
  unsigned repetitions = 0;
  std::vector<BytesRow> rows;
  std::vector<Target> targets;
};

/// Decodes every form once for each chunk and compares voxels and light; aborts if they differ.
/// Single-threaded. Fails if the Luanti world is wanted and cannot be read.
Result<BytesBench, std::string> run_bytes_bench(const BenchOptions& options,
                                                std::ostream& progress);

void write_table(const BytesBench& bench, std::ostream& out);
void write_csv(const BytesBench& bench, std::ostream& out);
void write_json(const BytesBench& bench, std::ostream& out);

}  // namespace runstone::bench
