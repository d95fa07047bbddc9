// Siege charts: latency, memory and disk over the time of a siege, as SVG files.
#pragma once
#include <string>

#include "tests/bench/network/net_options.hpp"
#include "tests/bench/network/siege_result.hpp"
#include "tests/bench/network/testbed.hpp"

namespace runstone::bench {

/// Writes siege-p99.svg, siege-memory.svg and siege-disk.svg into `folder`, which it makes if it is
/// missing. Fails if a file cannot be written.
Done write_siege_charts(const SiegeResult& result, const NetOptions& options,
                        const std::string& folder);

}  // namespace runstone::bench
