#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "tests/conformance/scene/checklist.hpp"
#include "tests/conformance/scene/scene.hpp"

namespace runstone::test {

TEST_CASE("each scene of the conformance kit has a name of its own and a section of the page",
          "[conformance]") {
  std::ifstream in(std::string(RUNSTONE_SOURCE_DIR) + "/docs/protocol.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  std::set<std::string> names;
  for (const conformance::Scene& scene : conformance::all_scenes()) {
    CAPTURE(scene.name);
    CHECK(names.insert(scene.name).second);
    CHECK(page.find("# " + scene.section + "\n") != std::string::npos);
    CHECK_FALSE(scene.words.empty());
  }
}

TEST_CASE("the page of the conformance kit has a row for each scene", "[conformance]") {
  std::ifstream in(std::string(RUNSTONE_SOURCE_DIR) + "/docs/conformance.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  for (const conformance::Scene& scene : conformance::all_scenes())
    CHECK(page.find("| `" + scene.name + "` | " + scene.words + " |") != std::string::npos);
}

TEST_CASE("a scene of the minimum that was not tried is not passed", "[conformance]") {
  using namespace conformance;
  const auto row = [](Part part, Mark mark) {
    return Row{{"name", "section", part, "words", nullptr}, mark, ""};
  };
  const Row passed = row(Part::minimum, Mark::passed);
  CHECK(is_passed({passed, row(Part::further, Mark::not_tried)}));
  CHECK_FALSE(is_passed({passed, row(Part::minimum, Mark::not_tried)}));
  CHECK_FALSE(is_passed({passed, row(Part::further, Mark::failed)}));
}

}  // namespace runstone::test
