// Videos with programs in place of ffmpeg.
#include "server/replay/video.hpp"

#include <stdlib.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/core/text_contains.hpp"

namespace runstone::test {
namespace {

namespace fs = std::filesystem;

/// A folder for a video, and a shell script in place of ffmpeg. Its variable $last is the file to
/// write.
class VideoBench {
 public:
  VideoBench() : path_before_(::getenv("PATH")) {
    fs::create_directories(folder_ / "bin");
    fs::create_directories(frames());
    REQUIRE(::setenv("PATH", (folder_ / "bin").c_str(), 1) == 0);
  }
  ~VideoBench() { ::setenv("PATH", path_before_.c_str(), 1); }
  VideoBench(const VideoBench&) = delete;
  VideoBench& operator=(const VideoBench&) = delete;

  std::string frames() const { return folder_ / "frames"; }
  std::string video() const { return frames() + "/timelapse.mp4"; }
  /// Returns the error, or an empty text.
  std::string make(const std::string& script) const {
    const std::string program = folder_ / "bin/ffmpeg";
    std::ofstream(program) << "#!/bin/sh\nfor last; do :; done\n" << script << "\n";
    fs::permissions(program, fs::perms::owner_all);
    const auto made = make_video(frames(), 30);
    return made ? "" : made.error();
  }
  std::string text() const {
    std::ifstream in(video());
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::ptrdiff_t file_count() const {
    return std::distance(fs::directory_iterator(frames()), fs::directory_iterator());
  }

 private:
  const std::string path_before_;
  TempFolder folder_;
};

}  // namespace

TEST_CASE_METHOD(VideoBench, "a video gets its name when it is complete", "[replay]") {
  CHECK(make("echo video > \"$last\"") == "");
  CHECK(text() == "video\n");
  CHECK(file_count() == 1);
}

TEST_CASE_METHOD(VideoBench, "of a video that could not be written nothing is left", "[replay]") {
  CHECK(make("echo half > \"$last\"; exit 1") == "ffmpeg ended with exit code 1");
  CHECK(file_count() == 0);
  CHECK(make("echo half > \"$last\"; kill -9 $$") == "ffmpeg was ended by signal 9");
  CHECK(file_count() == 0);
  CHECK(make(": > \"$last\"") == "timelapse.mp4: cannot be written: ffmpeg has written nothing");
  CHECK(file_count() == 0);
  CHECK(make("exit 0") == "timelapse.mp4: cannot be written: No such file or directory");
  CHECK(file_count() == 0);
}

TEST_CASE_METHOD(VideoBench, "an old video stays until the new one is complete", "[replay]") {
  std::ofstream(video()) << "old";
  CHECK(make("echo half > \"$last\"; exit 1") != "");
  CHECK(text() == "old");
  CHECK(make("echo new > \"$last\"") == "");
  CHECK(text() == "new\n");
}

TEST_CASE_METHOD(VideoBench, "a link stays where a video is written, and no world is replaced",
                 "[replay]") {
  fs::create_symlink("far.mp4", video());
  CHECK(make("echo video > \"$last\"") == "");
  CHECK(fs::is_symlink(video()));
  CHECK(fs::is_regular_file(frames() + "/far.mp4"));
  fs::remove(video());
  // The unfinished video lies beside the file to which the link leads, so both are on one file system.
  fs::create_directory(frames() + "/far");
  fs::create_symlink("far/far.mp4", video());
  CHECK(make("echo \"$last\" > \"$last\"") == "");
  CHECK(contains(text(), "/frames/far/timelapse.partial.mp4\n"));
  CHECK(fs::is_symlink(video()));
  fs::remove(video());
  std::ofstream(frames() + "/world.sqlite") << "a world";
  fs::create_symlink("world.sqlite", video());
  CHECK(contains(make("echo video > \"$last\""), "timelapse.mp4: is not overwritten"));
  CHECK(fs::file_size(frames() + "/world.sqlite") == 7);
  fs::remove(video());
  fs::create_symlink("/dev/full", video());
  CHECK(contains(make("echo video > \"$last\""), "it is a device or a pipe"));
  CHECK(fs::is_character_file("/dev/full"));
}

}  // namespace runstone::test
