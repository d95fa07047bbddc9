#include "common/os/private_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {
namespace {

std::string error_of(const std::string& file, std::size_t bytes_max = 100) {
  const auto read = read_file(file, bytes_max);
  return read ? "no error" : read.error();
}

}  // namespace

TEST_CASE("a file is read as a whole, up to its limit", "[os]") {
  const TempFolder folder;
  const std::string file = folder / "settings.toml";
  std::ofstream(file) << std::string(100, 'a');
  CHECK(*read_file(file, 100) == std::string(100, 'a'));
  CHECK(*read_file_bytes(file, 100) == Bytes(100, 'a'));
  CHECK(read_file_bytes(file, 99).error() == file + ": is larger than 99 bytes");
  CHECK(error_of(file, 99) == file + ": is larger than 99 bytes");
  std::ofstream(file, std::ios::trunc).flush();
  CHECK(*read_file(file, 100) == std::string());
  CHECK(error_of(folder / "none") ==
        (folder / "none") + ": cannot be read: No such file or directory");
}

TEST_CASE("a device, a pipe or a folder is refused at once, whatever it would give", "[os]") {
  const TempFolder folder;
  CHECK(error_of(folder.path()) == folder.path() + ": is a folder");
  CHECK(error_of("/dev/zero") == "/dev/zero: is a device, a pipe or a socket, and no file");
  CHECK(error_of("/dev/null").find("is a device") != std::string::npos);
  const std::string pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(error_of(pipe).find("a pipe") != std::string::npos);
}

TEST_CASE("the kind of a file is checked without opening it", "[os]") {
  const TempFolder folder;
  const auto words = [](const std::string& file, FileKinds kinds = FileKinds::regular) {
    const auto kind = check_file_kind(file, kinds);
    return kind ? std::string("no error") : kind.error();
  };
  const std::string file = folder / "file";
  std::ofstream(file) << "x";
  CHECK(words(file) == "no error");
  CHECK(words(folder.path()) == folder.path() + ": is a folder");
  CHECK(words("/dev/zero") == "/dev/zero: is a device, a pipe or a socket, and no file");
  CHECK(words(folder / "none") ==
        (folder / "none") + ": cannot be read: No such file or directory");
  const std::string pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(words(pipe) == pipe + ": is a device, a pipe or a socket, and no file");
  CHECK(words(pipe, FileKinds::regular_or_pipe) == "no error");
}

TEST_CASE("an option may name a pipe, which is read to its end", "[os]") {
  int ends[2] = {};
  REQUIRE(::pipe(ends) == 0);
  REQUIRE(::write(ends[1], "secret\n", 7) == 7);
  ::close(ends[1]);
  const std::string pipe = "/dev/fd/" + std::to_string(ends[0]);
  CHECK(*read_file(pipe, 100, FileKinds::regular_or_pipe) == "secret\n");
  ::close(ends[0]);
}

TEST_CASE("a file without a known size ends at the limit", "[os]") {
  CHECK(read_file("/proc/self/stat", 4096).has_value());
  CHECK(error_of("/proc/self/maps", 10) == "/proc/self/maps: is larger than 10 bytes");
}

}  // namespace runstone::test
