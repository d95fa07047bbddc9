#include "server/world/cluster/owner_choice.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

/// An owner with two followers, 7 and 8, whose players edit at a steady rate.
struct ChoiceBench {
  OwnerChoice choice;
  OwnerChoice::Counts counts{0, {{7, 0}, {8, 0}}};
  TimeUs now_us = 0;
  /// Lets a window pass in which the players made so many edits.
  std::optional<SessionId> window(std::uint64_t here, std::uint64_t at_7, std::uint64_t at_8) {
    if (now_us == 0) CHECK_FALSE(choice.look(counts, now_us).has_value());
    counts.here += here;
    counts.there[7] += at_7;
    counts.there[8] += at_8;
    now_us += kOwnerWindowUs;
    return choice.look(counts, now_us);
  }
};

}  // namespace

TEST_CASE("a world moves after three windows in which most edits came from one server",
          "[world][servers]") {
  ChoiceBench bench;
  CHECK_FALSE(bench.window(10, 50, 0).has_value());
  CHECK_FALSE(bench.window(16, 50, 0).has_value());
  CHECK(bench.window(0, 100, 33) == 7U);
  // The same move is not tried again within a minute, also if it has failed.
  for (int i = 0; i < 5; ++i) CHECK_FALSE(bench.window(0, 100, 0).has_value());
  CHECK(bench.window(0, 100, 0) == 7U);
}

TEST_CASE("a world stays where no server has enough of the edits for long enough",
          "[world][servers]") {
  ChoiceBench bench;
  const auto stays = [&](std::uint64_t here, std::uint64_t at_7, std::uint64_t at_8) {
    for (int i = 0; i < 6; ++i) {
      if (bench.window(here, at_7, at_8)) return false;
    }
    return true;
  };
  CHECK(stays(0, 0, 0));
  CHECK(stays(0, 49, 0));   // fewer than five a second
  CHECK(stays(20, 60, 0));  // three quarters, and not more
  CHECK(stays(0, 300, 100));
  CHECK(stays(400, 100, 0));
  for (int i = 0; i < 3; ++i) {  // another server in each window
    CHECK_FALSE(bench.window(0, 100, 0).has_value());
    CHECK_FALSE(bench.window(0, 100, 0).has_value());
    CHECK_FALSE(bench.window(0, 0, 100).has_value());
    CHECK_FALSE(bench.window(0, 0, 100).has_value());
  }
}

TEST_CASE("a new owner keeps the world for a minute, and a window is ten seconds long",
          "[world][servers]") {
  ChoiceBench bench;
  bench.choice.begin(0);
  for (int i = 0; i < 5; ++i) CHECK_FALSE(bench.window(0, 100, 0).has_value());
  CHECK_FALSE(bench.choice.is_due(bench.now_us + kOwnerWindowUs - 1));
  CHECK_FALSE(bench.choice.look({0, {{7, 10'000}}}, bench.now_us + 1).has_value());
  CHECK(bench.window(0, 100, 0) == 7U);
}

}  // namespace runstone
