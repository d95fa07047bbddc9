#include "server/world/people/visits.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/commit/feature_bench.hpp"

namespace runstone::test {
namespace {

constexpr std::uint64_t kReads = kFeatureChat | kFeatureVisits;

struct VisitBench : FeatureBench {
  using FeatureBench::FeatureBench;

  std::vector<std::string> visits(SessionId session) const {
    std::vector<std::string> all;
    for (const ChatLines& message : environment.messages<ChatLines>(session, kEdge)) {
      for (const ChatLine& line : message.lines) {
        CHECK(line.kind == ChatLineKind::visit);
        all.push_back(line.text);
      }
    }
    return all;
  }
  void wait(TimeUs for_us) {
    for (TimeUs passed_us = 0; passed_us < for_us; passed_us += 1'000'000) tick(1'000'000);
  }
};

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("others read who has joined and who has left", "[world][visits]") {
  VisitBench bench;
  bench.join_with(1, 1, kReads);
  bench.join_with(2, 2, kReads);
  bench.join_with(3, 3, kFeatureChat);
  CHECK(bench.visits(1) == Lines{"player2 has joined", "player3 has joined"});
  CHECK(bench.visits(2) == Lines{"player3 has joined"});
  CHECK(bench.visits(3).empty());  // an older client
  bench.server.disconnected(3);
  bench.wait(kVisitPauseUs - 1'000'000);
  CHECK(bench.visits(2).size() == 1);
  bench.wait(3'000'000);
  CHECK(bench.visits(2) == Lines{"player3 has joined", "player3 has left"});
  CHECK(bench.environment.chat.empty());
}

TEST_CASE("a player who comes back soon has not left", "[world][visits]") {
  VisitBench bench;
  bench.join_with(1, 1, kReads);
  bench.join_with(2, 2, kReads);
  bench.server.disconnected(2);
  bench.wait(5'000'000);
  bench.join_with(3, 2, kReads);
  bench.wait(kVisitPauseUs + 3'000'000);
  CHECK(bench.visits(1) == Lines{"player2 has joined"});
  bench.server.disconnected(3);
  bench.wait(kVisitPauseUs + 3'000'000);
  bench.join_with(4, 2, kReads);
  CHECK(bench.visits(1) == Lines{"player2 has joined", "player2 has left", "player2 has joined"});
}

TEST_CASE("a crowd that comes at once makes few lines", "[world][visits]") {
  VisitBench bench;
  bench.join_with(1, 1, kReads);
  for (std::uint8_t who = 2; who < 40; ++who) bench.join_with(who, who, kReads);
  // The line about the first player counts, although nobody else was there to get it.
  CHECK(bench.visits(1).size() == kVisitLineBurst - 1);
}

TEST_CASE("after a takeover the players who are here count as joined", "[world][visits]") {
  VisitBench bench;
  bench.join_with(1, 1, kReads);
  bench.tick();
  bench.server.people().visits().begin_anew();  // as after a takeover
  bench.join_with(2, 2, kReads);
  bench.server.disconnected(1);
  bench.wait(kVisitPauseUs + 3'000'000);
  CHECK(bench.visits(2) == Lines{"player1 has left"});
}

}  // namespace runstone::test
