// `runstone-bench frames`: the cost of drawing each mesher's polygons, and the differences of their
// pictures (thesis 8.5, 4.2.1, 4.2.2).
#pragma once
#include <iosfwd>
#include <string>

#include "bench/frames/frames_options.hpp"
#include "bench/frames/frames_result.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Draws off screen, on the calling thread and the driver's threads. Prints a line of progress for
/// each world. Fails, and names what was tried, if there is no OpenGL context; if the driver fails;
/// or if the Luanti world is wanted and cannot be read.
Result<FramesResult, std::string> run_frames_bench(const FramesOptions& options,
                                                   std::ostream& progress);

}  // namespace runstone::bench
