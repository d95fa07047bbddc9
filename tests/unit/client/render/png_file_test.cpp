#include "client/render/png_file.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {
namespace {

Image two_pixels() { return {2, 1, {255, 0, 0, 0, 0, 255}}; }

std::string file_bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a picture is a whole PNG file, which replaces the old one", "[render]") {
  const TempFolder folder;
  const std::string file = folder / "a.png";
  std::ofstream(file) << "an old picture";
  REQUIRE(write_png(file, two_pixels()).has_value());
  const Bytes encoded = encode_png(two_pixels());
  const std::string bytes = file_bytes_of(file);
  CHECK(bytes == std::string(encoded.begin(), encoded.end()));
  CHECK(bytes.starts_with("\x89PNG\r\n\x1a\n"));
  CHECK(bytes.ends_with("IEND\xae\x42\x60\x82"));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("a picture never replaces a world or a key", "[render]") {
  const TempFolder folder;
  const std::string database = std::string("SQLite format 3\0", 16) + "and pages";
  for (const char* name : {"world.sqlite", "world.durable", "server.key", "renamed.png"}) {
    CAPTURE(name);
    const std::string file = folder / name;
    std::ofstream(file, std::ios::binary) << database;
    const auto written = write_png(file, two_pixels());
    REQUIRE_FALSE(written.has_value());
    CHECK(written.error().starts_with(file + ": is not overwritten: "));
    CHECK(file_bytes_of(file) == database);
  }
}

TEST_CASE("a picture that finds no room is an error with file and reason", "[render]") {
  CHECK(write_png("/dev/full", two_pixels()).error() ==
        "/dev/full: cannot be written: No space left on device");
  CHECK(std::filesystem::is_character_file("/dev/full"));
}

}  // namespace runstone::test
