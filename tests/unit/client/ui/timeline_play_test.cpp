#include "client/ui/timeline_play.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace runstone::test {

TEST_CASE("the log is played from a moment to its end, and then stops in the live world",
          "[client_ui]") {
  TimelinePlay play;
  CHECK_FALSE(play.is_playing());
  CHECK_FALSE(play.step(100, 100, false, 1, 10));
  play.start(50);
  std::vector<Sequence> shown;
  Sequence now = 100;  // the live world
  for (int i = 0; i < 200 && play.is_playing(); ++i) {
    if (const auto moment = play.step(100, now, false, 0.1, 10)) {
      shown.push_back(*moment);
      now = *moment;
    }
  }
  CHECK_FALSE(play.is_playing());
  REQUIRE(shown.size() >= 49);  // an edit a step: the sum of the steps is rounded
  CHECK(shown.size() <= 51);
  CHECK(shown.front() <= 51);
  CHECK(shown.back() == 100);
}

TEST_CASE("moments are left out while another one loads, so that the speed stays", "[client_ui]") {
  TimelinePlay play;
  play.start(0);
  REQUIRE(play.step(100, 100, false, 1.05, 10) == Sequence{10});
  for (int i = 0; i < 4; ++i) CHECK_FALSE(play.step(100, 100, true, 1, 10));
  CHECK(play.step(100, 10, false, 1, 10) == Sequence{60});
  CHECK_FALSE(play.step(100, 60, false, 0.01, 10));  // the same edit
  play.stop();
  CHECK_FALSE(play.step(100, 60, false, 5, 10));
}

TEST_CASE("a play stops if the server does not show the moment", "[client_ui]") {
  TimelinePlay play;
  play.start(0);
  REQUIRE(play.step(100, 100, false, 1, 10));
  CHECK_FALSE(play.step(100, 100, false, 1, 10));
  CHECK_FALSE(play.is_playing());
  play.start(0);  // and again, from the beginning
  CHECK(play.step(100, 100, false, 0.5, 10));
}

}  // namespace runstone::test
