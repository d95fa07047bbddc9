#include "client/display/look_control.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

using Times = std::array<TimeUs, LookControl::kLevels.size()>;

/// Draws `frames` frames on a machine on which a frame takes `took` by level. Returns how often the
/// level changed.
int draw(LookControl& control, const Times& took, int frames) {
  int changes = 0;
  for (int i = 0; i < frames; ++i) {
    const std::size_t before = control.level();
    control.frame_took(took[before]);
    changes += control.level() != before ? 1 : 0;
  }
  return changes;
}

constexpr Times kSlow = {100'000, 100'000, 100'000, 100'000, 100'000};
constexpr Times kFast = {500, 800, 1000, 1500, 2000};

}  // namespace

TEST_CASE("automatic quality finds the highest level that is fast enough", "[client_app]") {
  const auto look_after = [](const Times& took) {
    LookControl control(false);
    draw(control, took, 4000);
    return control.look(0);
  };
  CHECK(look_after(kFast).quality == Quality::high);
  CHECK(look_after({4000, 7000, 9000, 15'000, 60'000}).quality == Quality::medium);
  CHECK(look_after({9000, 15'000, 22'000, 60'000, 90'000}).quality == Quality::low);
  CHECK(look_after({9000, 15'000, 22'000, 60'000, 90'000}).scale == 1);
  CHECK(look_after({14'000, 24'000, 40'000, 60'000, 90'000}).scale == 0.75);
  CHECK(look_after({90'000, 150'000, 220'000, 600'000, 900'000}).scale == 0.5);
}

TEST_CASE("automatic quality leaves a level that is far too slow soon", "[client_app]") {
  LookControl control(false);
  draw(control, {20'000, 90'000, 120'000, 150'000, 200'000},
       static_cast<int>(3 * LookControl::kSlowFrames));
  CHECK(control.level() == 0);
}

TEST_CASE("automatic quality tries a level that is too slow less and less often", "[client_app]") {
  LookControl control(false);
  const Times took = {1000, 2000, 4000, 9000, 60'000};
  CHECK(draw(control, took, 2000) >= 4);
  CHECK(draw(control, took, 6000) <= 6);
}

TEST_CASE("a single slow frame changes nothing", "[client_app]") {
  LookControl control(false);
  draw(control, kFast, 1000);
  control.frame_took(500'000);
  CHECK(draw(control, kFast, 100) == 0);
}

TEST_CASE("a quality that is set stays, and exact pictures do not depend on the clock",
          "[client_app]") {
  LookControl control(false);
  control.set_quality(Quality::high);
  draw(control, kSlow, 1000);
  CHECK(control.look(0).quality == Quality::high);
  CHECK(control.look(0).scale == 1);
  CHECK(control.name() == "high");

  control.set_quality(std::nullopt);
  draw(control, kSlow, 1000);
  CHECK(control.name() == "auto: low at 50 %");

  LookControl exact(true);
  draw(exact, kSlow, 1000);
  CHECK(exact.look(0).quality == Quality::high);
  CHECK(exact.look(0).scale == 1);
  CHECK(exact.look(5'000'000).seconds == exact.look(0).seconds);
  CHECK(control.look(5'000'000).seconds == Approx(5));
}

TEST_CASE("quality has names", "[client_app]") {
  CHECK(parse_quality("medium") == Quality::medium);
  CHECK_FALSE(parse_quality("auto").has_value());
  CHECK_FALSE(parse_quality("").has_value());
}
