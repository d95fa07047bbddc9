// `runstone-bench client`: what a frame of the client costs: bursts of edits, own edits, and the
// effects of the picture.
#pragma once
#include <iosfwd>
#include <string>

#include "bench/client/client_options.hpp"
#include "bench/client/client_result.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Draws off screen. Prints a line of progress for each part. Fails, and names what was tried, if
/// there is no OpenGL context; if the driver fails; or if the Luanti world cannot be read.
Result<ClientBenchResult, std::string> run_client_bench(const ClientBenchOptions& options,
                                                        std::ostream& progress);

}  // namespace runstone::bench
