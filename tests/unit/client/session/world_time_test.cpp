// The time of the world and the place of the player at the client.
#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test {

using namespace session_bench;

namespace {

constexpr WorldTime kNight{0, 60};

struct TimeSession : SessionBench {
  void open_with(std::uint64_t features, const SessionAccepted& accepted = {6, 0}) {
    greet();
    Welcome welcome = server.make_welcome();
    welcome.features = features;
    welcome.signature =
        sign(server.keys_of_server, server_transcript(server.hello, welcome, std::nullopt));
    receive(welcome);
    receive(accepted);
    REQUIRE(session.is_open());
    static_cast<void>(sent());
  }
};

}  // namespace

TEST_CASE_METHOD(TimeSession, "a client runs the clock of the world by itself",
                 "[session][world_time]") {
  open_with(kFeatureWorldTime);
  CHECK((server.hello.features & kFeatureWorldTime) != 0);
  CHECK(session.world_time(now) == std::nullopt);
  receive(kNight);
  const TimeUs got_us = now;
  CHECK(session.world_time(got_us)->rate == 60);
  const auto later_on = session.world_time(got_us + 60'000'000);
  REQUIRE(later_on.has_value());
  CHECK(later_on->day_ms >= 3'600'000);
  // The time goes on while the connection is lost. The server sends it again after that.
  session.disconnected();
  CHECK(session.world_time(got_us + 60'000'000) == later_on);
  // A server without the feature sends no time.
  open_with(kFeatureChat);
  CHECK(session.world_time(now) == std::nullopt);
  receive(kNight);
  REQUIRE(session.end().has_value());
  CHECK(session.end()->reason == GoodbyeReason::unexpected_message);
}

TEST_CASE_METHOD(TimeSession, "a place counts only with its feature", "[session][world_time]") {
  SessionAccepted accepted{6, 0};
  accepted.place = Pose{{1, 2, 3}, 4, 5};
  open_with(kFeatureVisits, accepted);
  CHECK(session.place() == accepted.place);
  session.disconnected();
  open_with(kFeatureChat, accepted);
  CHECK(session.place() == std::nullopt);
}

}  // namespace runstone::test
