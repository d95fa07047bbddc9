// Videos: numbered pictures are joined by ffmpeg, if it is installed.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// Joins frame-000001.png and so on in `folder` into timelapse.mp4 there. Blocks until the video is
/// complete and on disk. Fails if ffmpeg is not installed or fails, or if the video cannot be written.
/// After an error an old video is unchanged, and no part of the new one is left. The error is one
/// line; ffmpeg prints its reason to standard error.
Result<void, std::string> make_video(const std::string& folder, std::uint32_t fps);

/// Returns the shell command that joins the pictures in their folder, for a person to type.
std::string video_command(std::uint32_t fps);

}  // namespace runstone
