// runstone-replay --timelapse as a function: options in, table and report out.
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "server/replay/replay_options.hpp"

namespace runstone {

/// Draws the frames, and joins them into a video if ffmpeg is there. `out` takes the table; progress goes to the
/// terminal, if there is one. A missing ffmpeg is no error. Errors are one line.
Result<void, std::string> timelapse_program(const ReplayOptions& options, std::ostream& out);

}  // namespace runstone
