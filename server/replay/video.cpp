#include "server/replay/video.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "common/os/child_program.hpp"
#include "common/os/file_writer.hpp"
#include "common/os/output_file.hpp"

namespace runstone {
namespace {

constexpr const char* kVideo = "timelapse.mp4";
/// ffmpeg writes this file, which becomes the video when it is complete.
constexpr const char* kPartialVideo = "timelapse.partial.mp4";

/// Removes a file at the end of its scope, if it is still there.
class RemovedAtEnd {
 public:
  explicit RemovedAtEnd(std::string file) : file_(std::move(file)) {}
  ~RemovedAtEnd() { ::unlink(file_.c_str()); }
  RemovedAtEnd(const RemovedAtEnd&) = delete;
  RemovedAtEnd& operator=(const RemovedAtEnd&) = delete;

 private:
  const std::string file_;
};

std::vector<std::string> words_of_command(std::uint32_t fps, const std::string& video) {
  // Without -xerror some versions of ffmpeg exit with 0 although the disk had no space for the end of
  // the video. Video players expect yuv420p, which has half the resolution for colours and needs even
  // sides.
  return {"ffmpeg",     "-y",
          "-loglevel",  "error",
          "-framerate", std::to_string(fps),
          "-i",         "frame-%06d.png",
          "-vf",        "pad=ceil(iw/2)*2:ceil(ih/2)*2",
          "-pix_fmt",   "yuv420p",
          "-xerror",    video};
}

/// Joins the frames of the folder into `video`, an absolute path. Fails with the reason.
Result<void, std::string> run_ffmpeg(const std::string& folder, std::uint32_t fps,
                                     const std::string& video) {
  const auto ffmpeg_failure = [](std::string why) { return failure("ffmpeg " + std::move(why)); };
  const auto pid = start_program({words_of_command(fps, video), -1, -1, folder});
  if (!pid) {
    return ffmpeg_failure(pid.error() == ENOENT
                              ? "is not installed"
                              : std::string("cannot be started: ") + std::strerror(pid.error()));
  }
  int status = 0;
  while (::waitpid(*pid, &status, 0) < 0) {
    if (errno != EINTR) return ffmpeg_failure("is no longer a child process");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return ffmpeg_failure(how_it_ended(status));
  return {};
}

/// Puts the bytes of a file on disk. Fails with the reason. An empty file is an error, too.
Result<void, std::string> sync_video(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return failure(std::string(std::strerror(errno)));
  struct stat about{};
  int error = ::fstat(descriptor, &about) == 0 ? 0 : errno;
  if (error == 0 && ::fsync(descriptor) != 0) error = errno;
  ::close(descriptor);
  if (error != 0) return failure(std::string(std::strerror(error)));
  if (about.st_size == 0) return failure(std::string("ffmpeg has written nothing"));
  return {};
}

}  // namespace

Result<void, std::string> make_video(const std::string& folder, std::uint32_t fps) {
  const auto cannot = [](const std::string& why) {
    return failure(std::string(kVideo) + ": cannot be written: " + why);
  };
  const std::string video = without_links(folder + "/" + kVideo);
  if (const std::string refusal = output_refusal(video); !refusal.empty())
    return failure(std::string(kVideo) + ": " + refusal);
  if (is_written_in_place(video)) return cannot("it is a device or a pipe");
  // Only a file on the same file system can replace the video, to which a link may lead.
  const std::string partial =
      (std::filesystem::absolute(video).parent_path() / kPartialVideo).string();
  const RemovedAtEnd removed(partial);
  if (const auto ran = run_ffmpeg(folder, fps, partial); !ran) return ran;
  if (const auto synced = sync_video(partial); !synced) return cannot(synced.error());
  if (std::rename(partial.c_str(), video.c_str()) != 0) return cannot(std::strerror(errno));
  sync_folder_of(video);
  return {};
}

std::string video_command(std::uint32_t fps) {
  std::string command;
  for (const std::string& word : words_of_command(fps, kVideo)) {
    const bool is_plain = word.find_first_of("()*%") == std::string::npos;
    command += (command.empty() ? "" : " ") + (is_plain ? word : "'" + word + "'");
  }
  return command;
}

}  // namespace runstone
