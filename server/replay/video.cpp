#include "server/replay/video.hpp"

#include <sys/wait.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "common/os/child_program.hpp"

namespace runstone {
namespace {

std::vector<std::string> words_of_command(std::uint32_t fps) {
  // Video players expect yuv420p, which has half the resolution for colours and needs even sides.
  return {"ffmpeg",       "-y",
          "-loglevel",    "error",
          "-framerate",   std::to_string(fps),
          "-i",           "frame-%06d.png",
          "-vf",          "pad=ceil(iw/2)*2:ceil(ih/2)*2",
          "-pix_fmt",     "yuv420p",
          "timelapse.mp4"};
}

}  // namespace

Result<void, std::string> make_video(const std::string& folder, std::uint32_t fps) {
  const auto video_failure = [](std::string why) { return failure("ffmpeg " + std::move(why)); };
  const auto pid = start_program({words_of_command(fps), -1, -1, folder});
  if (!pid) {
    return video_failure(pid.error() == ENOENT
                             ? "is not installed"
                             : std::string("cannot be started: ") + std::strerror(pid.error()));
  }
  int status = 0;
  while (::waitpid(*pid, &status, 0) < 0) {
    if (errno != EINTR) return video_failure("is no longer a child process");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return video_failure(how_it_ended(status));
  return {};
}

std::string video_command(std::uint32_t fps) {
  std::string command;
  for (const std::string& word : words_of_command(fps)) {
    const bool is_plain = word.find_first_of("()*%") == std::string::npos;
    command += (command.empty() ? "" : " ") + (is_plain ? word : "'" + word + "'");
  }
  return command;
}

}  // namespace runstone
