// CMake splits lists at semicolons. CTest would run a test whose name has one under a part of the
// name, which matches no case, and report that it has passed.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

TEST_CASE("no test has a semicolon in its name", "[house]") {
  const std::regex name(R"re(TEST_CASE\(\s*("[^"]*"\s*)+)re");
  std::size_t names = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(RUNSTONE_SOURCE_DIR "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path());
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    for (std::sregex_iterator found(text.begin(), text.end(), name), end; found != end; ++found) {
      ++names;
      INFO(entry.path() << ": " << found->str());
      CHECK(found->str().find(';') == std::string::npos);
    }
  }
  CHECK(names > 1'000);
}
