// `runstone-bench storage`: every way to keep voxels on every volume: bytes, and what reading, walking and editing
// costs.
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "tests/bench/app/bench_options.hpp"
#include "tests/bench/storage/storage_result.hpp"

namespace runstone::bench {

/// Progress goes to `progress`, a line a world and edge. Fails if a world cannot be read. Requires edges that
/// are powers of two.
Result<StorageResult, std::string> run_storage_bench(const BenchOptions& options,
                                                     std::ostream& progress);

}  // namespace runstone::bench
