// The newest entry of CHANGELOG.md that is no "Unreleased" is about the version that the programs print.
#include <catch2/catch.hpp>
#include <fstream>
#include <string>

#include "common/core/version.hpp"

TEST_CASE("the changelog begins with the version of the programs", "[house][docs]") {
  std::ifstream in(RUNSTONE_SOURCE_DIR "/CHANGELOG.md");
  std::string line;
  while (std::getline(in, line) && (!line.starts_with("## ") || line == "## Unreleased")) {
  }
  CHECK(line == "## " + std::string(runstone::version()));
}
