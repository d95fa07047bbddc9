#include "common/os/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using runstone::test::TempFolder;

namespace {

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("an output file replaces the old one and leaves nothing else behind", "[os]") {
  const TempFolder folder;
  const std::string file = folder / "report.json";
  REQUIRE(write_output_file(file, "first, longer").has_value());
  REQUIRE(write_output_file(file, std::string("a\0b", 3)).has_value());
  CHECK(content_of(file) == std::string("a\0b", 3));
  CHECK(content_of(file + ".new").empty());
  CHECK(write_output_file("/dev/null", "in place").has_value());
}

TEST_CASE("a file that cannot be written is named", "[os]") {
  const TempFolder folder;
  const std::string file = folder / "no/report.json";
  CHECK(write_output_file(file, "x").error() ==
        file + ": cannot be written: No such file or directory");
  CHECK(write_output_file(folder.path(), "x").error() == folder.path() + ": is a folder");
}

TEST_CASE("databases and keys are not overwritten, whatever they are called", "[os]") {
  const TempFolder folder;
  const std::string database = folder / "renamed.json";
  const std::string bytes = std::string("SQLite format 3\0", 16) + "and pages";
  std::ofstream(database, std::ios::binary) << bytes;
  REQUIRE_FALSE(write_output_file(database, "{}").has_value());
  CHECK(content_of(database) == bytes);
  for (const char* name : {"world.sqlite", "world.sqlite-wal", "cache.sqlite-shm",
                           "world.sqlite-journal", "world.durable", "world.lock", "server.key"}) {
    CAPTURE(name);
    const std::string file = folder / name;
    CHECK_FALSE(output_refusal(file).empty());
    std::ofstream(file) << "a key";
    CHECK_FALSE(write_output_file(file, "{}").has_value());
    CHECK(content_of(file) == "a key");
  }
  CHECK(output_refusal(folder / "sqlite.json").empty());
  std::filesystem::create_symlink(folder / "server.key", folder / "link.json");
  CHECK_FALSE(output_refusal(folder / "link.json").empty());
}

TEST_CASE("a full device stays a device, and the reason is named", "[os]") {
  CHECK(write_output_file("/dev/full", "x").error() ==
        "/dev/full: cannot be written: No space left on device");
  CHECK(std::filesystem::is_character_file("/dev/full"));
}

TEST_CASE("a symbolic link stays, and its target is replaced", "[os]") {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "disk");
  std::ofstream(folder / "disk/report.json") << "old";
  std::filesystem::permissions(folder / "disk/report.json", std::filesystem::perms::owner_all);
  std::filesystem::create_symlink("disk/report.json", folder / "report.json");
  std::filesystem::create_symlink("disk/none.json", folder / "dangling.json");
  for (const char* name : {"report.json", "dangling.json"}) {
    CAPTURE(name);
    REQUIRE(write_output_file(folder / name, "new").has_value());
    CHECK(std::filesystem::is_symlink(folder / name));
    CHECK(content_of(folder / name) == "new");
  }
  CHECK(content_of(folder / "disk/none.json") == "new");
  // The permissions of the old file are not widened.
  const auto mode = std::filesystem::status(folder / "disk/report.json").permissions();
  CHECK((mode & (std::filesystem::perms::group_all | std::filesystem::perms::others_all)) ==
        std::filesystem::perms::none);
}

TEST_CASE("a named pipe is written for its reader, and without one the call fails at once",
          "[os]") {
  const TempFolder folder;
  const std::string pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(write_output_file(pipe, "x").error() == pipe + ": cannot be written: nobody reads it");
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  REQUIRE(reader >= 0);
  CHECK(empty_output_file(pipe).has_value());
  CHECK(write_output_file(pipe, "4747").has_value());
  char bytes[8] = {};
  CHECK(::read(reader, bytes, sizeof bytes) == 4);
  ::close(reader);
}

TEST_CASE("an unfinished file is removed, and a file of its name is not touched", "[os]") {
  const TempFolder folder;
  const std::string file = folder / "log.rlog";
  std::ofstream(file + ".new") << "of the user";
  {
    auto out = open_output_file(file);
    REQUIRE(out);
    CHECK(out->write("half"));
  }
  CHECK_FALSE(std::filesystem::exists(file));
  CHECK(content_of(file + ".new") == "of the user");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}
