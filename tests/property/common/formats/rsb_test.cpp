// Random builds pass through .rsb files unchanged, and random damage never passes as a build.
#include <catch2/catch.hpp>

#include "common/runs/reorder.hpp"
#include "tests/support/formats/rsb_bytes.hpp"

namespace runstone::test {

TEST_CASE("random builds come back from their .rsb cell by cell", "[rsb][property]") {
  SplitMix64 rng(Catch::rngSeed());
  for (int step = 0; step < 60; ++step) {
    const SampleBuild build = random_build(rng);
    const int level = rng.below(2) == 0 ? 0 : 3;
    CAPTURE(Catch::rngSeed(), step, level);
    const RsbContents read = read_rsb(rsb_of(build, level));
    if (read.error) FAIL(read.error->message());
    REQUIRE(read.build.info == build.info);
    REQUIRE(read.build.materials == build.materials);
    REQUIRE(read.build.sections.size() == build.sections.size());
    for (std::size_t i = 0; i < build.sections.size(); ++i) {
      REQUIRE(read.build.sections[i].at == build.sections[i].at);
      REQUIRE(read.build.sections[i].cells == reorder(build.sections[i].cells, AxisOrder::xyz));
    }
  }
}

TEST_CASE("an .rsb whose bytes change at random under correct checksums is valid or an error",
          "[rsb][property]") {
  SplitMix64 rng(Catch::rngSeed());
  int sound = 0;
  for (int step = 0; step < 400; ++step) {
    const SampleBuild build = random_build(rng);
    Bytes file = rsb_of(build, 0);
    const auto at = rng.below(static_cast<std::uint32_t>(file.size()));
    file[at] = static_cast<std::uint8_t>(rng.next());
    mend_rsb(file);
    CAPTURE(Catch::rngSeed(), step, at);
    const RsbContents read = read_rsb(file);
    for (const BuildSection& section : read.build.sections) {
      REQUIRE(validate_section(section.cells, section_extent(read.build.info.sides, section.at),
                               static_cast<std::uint32_t>(read.build.materials.size()))
                  .has_value());
    }
    if (read.error) continue;
    ++sound;
    // What is read is a build that the writer accepts.
    const RsbContents again = read_rsb(rsb_of(read.build, 0));
    REQUIRE_FALSE(again.error.has_value());
    REQUIRE(again.build.sections == read.build.sections);
  }
  CHECK(sound > 0);
}

}  // namespace runstone::test
