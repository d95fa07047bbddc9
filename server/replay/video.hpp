// A video of numbered pictures, by ffmpeg, where that is installed.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// Joins frame-000001.png and so on in `folder` into timelapse.mp4 there, and waits until it is done. An error is
/// one line: ffmpeg is not installed, or failed (what it has to say goes to standard error).
Result<void, std::string> make_video(const std::string& folder, std::uint32_t fps);

/// The command that does it by hand, in that folder.
std::string video_command(std::uint32_t fps);

}  // namespace runstone
