#include "client/build/action_progress.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("progress has percent, voxels a second and the time left", "[client][build]") {
  ActionProgress progress;
  progress.voxels = 4'000'000;
  CHECK(text_of("fill", progress) == "fill: 0 percent, 0 voxels a second");
  progress.began_us = 1'000'000;
  progress.now_us = 3'000'000;
  progress.voxels_done = 1'000'000;
  CHECK(progress.percent() == 25);
  CHECK(progress.voxels_per_second() == 500'000);
  CHECK(progress.left_us() == 6'000'000);
  CHECK(text_of("fill", progress) == "fill: 25 percent, 500,000 voxels a second, 7 s left");
  progress.waits_for = "your edit budget";
  progress.edits_refused = 1;
  progress.voxels_refused = 1'234;
  progress.refusal = "the ground is protected: spawn";
  CHECK(text_of("fill", progress) ==
        "fill: 25 percent, 500,000 voxels a second, 6 s left; left out 1,234 voxels in 1 part: the "
        "ground is protected: spawn; waits for: your edit budget");
}

TEST_CASE("progress of an action of unknown size has no percent and no time left",
          "[client][build]") {
  ActionProgress progress;
  progress.voxels_done = 12;
  CHECK_FALSE(progress.percent().has_value());
  CHECK_FALSE(progress.left_us().has_value());
  CHECK(text_of("paste", progress) == "paste: 12 voxels, 0 voxels a second");
}

}  // namespace runstone::test
