#include "common/os/output_file.hpp"

#include <catch2/catch.hpp>
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
  CHECK(write_output_file(file, "x").error() == file + ": cannot be written");
  CHECK(write_output_file(folder.path(), "x").error() == folder.path() + ": is a folder");
}

TEST_CASE("databases and keys are not overwritten, whatever they are called", "[os]") {
  const TempFolder folder;
  const std::string database = folder / "renamed.json";
  const std::string bytes = std::string("SQLite format 3\0", 16) + "and pages";
  std::ofstream(database, std::ios::binary) << bytes;
  REQUIRE_FALSE(write_output_file(database, "{}").has_value());
  CHECK(content_of(database) == bytes);
  for (const char* name : {"world.sqlite", "world.sqlite-wal", "cache.sqlite-shm", "server.key"}) {
    CAPTURE(name);
    const std::string file = folder / name;
    CHECK_FALSE(output_refusal(file).empty());
    std::ofstream(file) << "a key";
    CHECK_FALSE(write_output_file(file, "{}").has_value());
    CHECK(content_of(file) == "a key");
  }
  CHECK(output_refusal(folder / "sqlite.json").empty());
}
