// The costs of durable edits in a world on SQLite and in one on PostgreSQL, on the same machine.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Commits of `batch` edits each, on both databases in turn.
struct StoreCommits {
  unsigned batch = 0;
  double sqlite_ms = 0, postgres_ms = 0;        // a commit, medians
  double sqlite_edits = 0, postgres_edits = 0;  // durable edits a second, from the medians
};

struct StoreBench {
  std::string postgres;  // its version
  unsigned commits = 0;  // of each batch and database
  std::vector<StoreCommits> batches;
};

/// Makes a world in a folder that it removes afterwards, and one in the database options.postgres,
/// in a schema that it removes as well. Both wait for the disk as a server does.
Result<StoreBench, std::string> run_store_bench(const BenchOptions& options,
                                                std::ostream& progress);

void write_table(const StoreBench& bench, std::ostream& out);
void write_json(const StoreBench& bench, std::ostream& out);

}  // namespace runstone::bench
