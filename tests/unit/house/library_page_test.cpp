// docs/library.md and docs/c.md show the examples as they are.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <string>

namespace {

std::string text_of_file(const std::string& path) {
  std::ifstream in(std::string(RUNSTONE_SOURCE_DIR) + "/" + path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE("the page for embedders holds the code of the examples", "[house][docs]") {
  const std::string page = text_of_file("docs/library.md");
  REQUIRE(!page.empty());
  for (const char* name : {"array_to_quads", "edit_layers", "walk_on_runs", "join_and_edit"}) {
    CAPTURE(name);
    const std::string code = text_of_file("examples/" + std::string(name) + ".cpp");
    REQUIRE(!code.empty());
    CHECK(page.find("```cpp\n" + code + "```\n") != std::string::npos);
  }
}

TEST_CASE("the page of the C interface holds its examples", "[house][docs]") {
  for (const char* name : {"hill", "join"}) {
    CAPTURE(name);
    const std::string code = text_of_file("examples/c/" + std::string(name) + ".c");
    REQUIRE(!code.empty());
    CHECK(text_of_file("docs/c.md").find("```c\n" + code + "```\n") != std::string::npos);
  }
}
