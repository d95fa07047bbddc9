// runstone-replay timelapse: draws a world as it grew, into pictures and a video.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "server/history/named_moment.hpp"
#include "server/replay/subcommand_options.hpp"
#include "server/replay/timelapse.hpp"

namespace runstone {

struct TimelapseCommandOptions {
  CommonOptions common;
  std::optional<NamedMoment> at;  // of the last frame; default: the end of the log
  TimelapseOptions timelapse;
  std::uint64_t fps = 30;  // frames a second of the video, 1..120
};

void declare_timelapse(SubcommandOptions& command_line, TimelapseCommandOptions& options);

/// Draws the frames, joins them into a video if ffmpeg is installed, and prints a table. A missing
/// ffmpeg is no error.
Result<int, std::string> run_timelapse(const TimelapseCommandOptions& options, std::ostream& out);

}  // namespace runstone
