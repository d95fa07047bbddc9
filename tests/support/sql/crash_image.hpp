// crash_image: the files of a world that is open, copied as kill -9 would leave them.
#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

namespace runstone::test {

/// Copies database, WAL and durable mark of the world in `from` to the folder `to`, which is made.
/// Requires that nobody writes the world meanwhile.
inline void copy_crash_image(const std::string& from, const std::string& to) {
  std::filesystem::create_directories(to);
  for (const char* name : {"/world.sqlite", "/world.sqlite-wal", "/world.durable"}) {
    REQUIRE(std::filesystem::exists(from + name));
    std::filesystem::copy_file(from + name, to + name,
                               std::filesystem::copy_options::overwrite_existing);
  }
}

/// Changes one bit of a file.
inline void flip_bit(const std::string& file, std::uintmax_t byte) {
  std::FILE* const both = std::fopen(file.c_str(), "r+b");
  REQUIRE(both != nullptr);
  const auto at = static_cast<long>(byte);
  REQUIRE(std::fseek(both, at, SEEK_SET) == 0);
  const int before = std::fgetc(both);
  REQUIRE(before != EOF);
  REQUIRE(std::fseek(both, at, SEEK_SET) == 0);
  REQUIRE(std::fputc(before ^ 1, both) != EOF);
  std::fclose(both);
}

}  // namespace runstone::test
