// `runstone-bench frames`: what the polygons of each mesher cost to draw, and whether they give the same
// picture (thesis 8.5, 4.2.1, 4.2.2).
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "tests/bench/frames/frames_options.hpp"
#include "tests/bench/frames/frames_result.hpp"

namespace runstone::bench {

/// Draws off screen, on the calling thread and those of the driver. Progress goes to `progress`, a line a
/// world. Fails if there is no OpenGL context, with what was tried, if the driver gives up, or if the Luanti
/// world is asked for and cannot be read.
Result<FramesResult, std::string> run_frames_bench(const FramesOptions& options,
                                                   std::ostream& progress);

}  // namespace runstone::bench
