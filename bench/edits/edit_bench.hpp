// `runstone-bench edits`: the costs of edits. Each case is timed many times on one core, and the
// medians are compared with the targets.
#pragma once
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/target.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

struct EditRow {
  std::string what;
  std::size_t chunks = 0, edits = 0;  // touched chunks; edits that one repetition applies
  double median_us = 0, p90_us = 0;   // of one repetition
};

struct EditBenchResult {
  Machine machine;
  std::vector<EditRow> rows;
  std::vector<Target> targets;
};

/// Fails if the temporary world of the replay cannot be written.
Result<EditBenchResult, std::string> run_edit_bench(const BenchOptions& options,
                                                    std::ostream& progress);

void write_table(const EditBenchResult& result, std::ostream& out);
void write_csv(const EditBenchResult& result, std::ostream& out);
void write_json(const EditBenchResult& result, std::ostream& out);

}  // namespace runstone::bench
