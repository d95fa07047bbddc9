#include "client/display/look_control.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

/// Draws `frames` frames on a machine on which a frame takes `took` by quality. Returns how often
/// the level changed.
int draw(LookControl& control, const std::array<TimeUs, 3>& took, int frames) {
  int changes = 0;
  Quality before = control.look(0).quality;
  for (int i = 0; i < frames; ++i) {
    control.frame_took(took[static_cast<std::size_t>(control.look(0).quality)]);
    changes += control.look(0).quality != before ? 1 : 0;
    before = control.look(0).quality;
  }
  return changes;
}

}  // namespace

TEST_CASE("automatic quality finds the highest level that is fast enough", "[client_app]") {
  const auto level_after = [](const std::array<TimeUs, 3>& took) {
    LookControl control(false);
    draw(control, took, 3000);
    return control.look(0).quality;
  };
  CHECK(level_after({1000, 1500, 2000}) == Quality::high);
  CHECK(level_after({9000, 15'000, 60'000}) == Quality::medium);
  CHECK(level_after({30'000, 60'000, 90'000}) == Quality::low);
}

TEST_CASE("automatic quality tries a level that is too slow less and less often", "[client_app]") {
  LookControl control(false);
  const std::array<TimeUs, 3> took = {4000, 9000, 60'000};
  CHECK(draw(control, took, 2000) >= 4);
  CHECK(draw(control, took, 6000) <= 6);
}

TEST_CASE("a single slow frame changes nothing", "[client_app]") {
  LookControl control(false);
  draw(control, {1000, 1500, 2000}, 1000);
  control.frame_took(500'000);
  CHECK(draw(control, {1000, 1500, 2000}, 100) == 0);
}

TEST_CASE("a quality that is set stays, and exact pictures do not depend on the clock",
          "[client_app]") {
  LookControl control(false);
  control.set_quality(Quality::high);
  draw(control, {100'000, 100'000, 100'000}, 1000);
  CHECK(control.look(0).quality == Quality::high);
  CHECK(control.name() == "high");

  LookControl exact(true);
  draw(exact, {100'000, 100'000, 100'000}, 1000);
  CHECK(exact.look(0).quality == Quality::high);
  CHECK(exact.look(5'000'000).seconds == exact.look(0).seconds);
  CHECK(control.look(5'000'000).seconds == Approx(5));
}

TEST_CASE("quality has names", "[client_app]") {
  CHECK(parse_quality("medium") == Quality::medium);
  CHECK_FALSE(parse_quality("auto").has_value());
  CHECK_FALSE(parse_quality("").has_value());
}
