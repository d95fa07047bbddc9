// `runstone-bench storage`: every way to store voxels on every volume: bytes, and the times to
// read, walk and edit.
#pragma once
#include <iosfwd>
#include <string>

#include "bench/harness/bench_options.hpp"
#include "bench/storage/storage_result.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Prints a line of progress for each world and edge. Fails if a world cannot be read. Requires
/// edges that are powers of two.
Result<StorageResult, std::string> run_storage_bench(const BenchOptions& options,
                                                     std::ostream& progress);

}  // namespace runstone::bench
