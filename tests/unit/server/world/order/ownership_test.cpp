#include "server/world/order/ownership.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

using State = OwnershipState;

/// Brings a server that has just started into a state.
void bring(Ownership& server, State state) {
  if (state == State::owning) return;
  if (state == State::log_lost) return server.lose_log();
  if (state == State::handing_over || state == State::handover_failed) {
    server.begin_handover();
    if (state == State::handover_failed) server.lose_log();
    return;
  }
  server.begin_following();
  if (state == State::forked) server.find_fork();
  if (state != State::taking_over && state != State::takeover_failed) return;
  server.begin_takeover();
  if (state == State::takeover_failed) server.fail_takeover();
}

TEST_CASE("a world goes from one server to another and back", "[world][servers]") {
  Ownership first, second;
  second.begin_following();
  CHECK(first.is(State::owning));
  CHECK(second.is(State::following));
  first.begin_handover();
  CHECK(first.is(State::handing_over));
  first.end_handover();
  CHECK(first.is(State::following));
  second.begin_takeover();
  CHECK(second.is(State::taking_over));
  second.end_takeover();
  CHECK(second.is(State::owning));
  second.begin_handover();
  second.end_handover();
  first.begin_takeover();
  first.end_takeover();
  CHECK(first.is(State::owning));
  CHECK(second.is(State::following));
}

TEST_CASE("a log that cannot be written ends an owner and a handover", "[world][servers]") {
  const auto after = [](State state) {
    Ownership server;
    bring(server, state);
    REQUIRE(server.is(state));
    server.lose_log();
    return server.state();
  };
  CHECK(after(State::owning) == State::log_lost);
  CHECK(after(State::handing_over) == State::handover_failed);
  // A server without a log has none to lose. A failure keeps its reason.
  for (const State state : {State::following, State::taking_over, State::log_lost,
                            State::handover_failed, State::forked, State::takeover_failed})
    CHECK(after(state) == state);
}

TEST_CASE("a fork is found while a server follows and when it takes the world over",
          "[world][servers]") {
  for (const State state : {State::following, State::taking_over, State::forked}) {
    Ownership server;
    bring(server, state);
    server.find_fork();
    CHECK(server.is(State::forked));
  }
}

TEST_CASE("the log decides whether a server that has forked may take the world over",
          "[world][servers]") {
  Ownership server;
  bring(server, State::forked);
  server.begin_takeover();
  CHECK(server.is(State::taking_over));
  SECTION("it is the log of this server") {
    server.end_takeover();
    CHECK(server.is(State::owning));
  }
  SECTION("it is another one") {
    server.find_fork();
    CHECK(server.is(State::forked));
  }
}

TEST_CASE("an owner keeps its world when it loses its log, and no other failure is of an owner",
          "[world][servers]") {
  struct Row {
    State state;
    bool owns, has_failed;
  };
  for (const Row row :
       {Row{State::owning, true, false}, Row{State::handing_over, false, false},
        Row{State::following, false, false}, Row{State::taking_over, false, false},
        Row{State::log_lost, true, true}, Row{State::handover_failed, false, true},
        Row{State::forked, false, true}, Row{State::takeover_failed, false, true}}) {
    Ownership server;
    bring(server, row.state);
    CHECK(server.state() == row.state);
    CHECK(owns(server.state()) == row.owns);
    CHECK(has_failed(server.state()) == row.has_failed);
  }
}

}  // namespace
}  // namespace runstone::test
