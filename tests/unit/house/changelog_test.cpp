// The newest version in CHANGELOG.md is the one that the programs print.
#include <catch2/catch.hpp>
#include <fstream>
#include <string>

#include "common/core/version.hpp"

TEST_CASE("the newest version in the changelog is that of the programs", "[house][docs]") {
  std::ifstream in(RUNSTONE_SOURCE_DIR "/CHANGELOG.md");
  std::string line;
  while (std::getline(in, line) && (!line.starts_with("## ") || line == "## Unreleased")) {
  }
  CHECK(line == "## " + std::string(runstone::version()));
}
