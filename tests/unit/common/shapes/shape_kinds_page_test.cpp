// The page of materials names every built-in kind.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <string>

#include "common/shapes/shape_kinds.hpp"

TEST_CASE("docs/materials.md names each kind of shape", "[shapes][docs]") {
  std::ifstream in(RUNSTONE_SOURCE_DIR "/docs/materials.md");
  const std::string page((std::istreambuf_iterator<char>(in)), {});
  const std::size_t begin = page.find("### Shapes"), end = page.find("## Adding materials");
  REQUIRE(begin < end);
  const std::string section = page.substr(begin, end - begin);
  for (const std::string_view kind : runstone::shape_kinds()) {
    CAPTURE(std::string(kind));
    CHECK(section.find('`' + std::string(kind) + '`') != std::string::npos);
  }
}
