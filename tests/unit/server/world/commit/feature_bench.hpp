// FeatureBench: a WorldBench whose clients join with the features that a test says.
#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <utility>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {

struct FeatureBench : WorldBench {
  using WorldBench::WorldBench;

  /// Sends hello, and returns it with the answer.
  std::pair<Hello, Welcome> greet(SessionId session, std::uint8_t who, std::uint64_t features) {
    server.connected(session, now());
    Hello h = hello(who);
    h.features = features;
    server.received(session, h, now());
    return {h, environment.messages<Welcome>(session, 0).at(0)};
  }
  /// Joins, and returns the welcome.
  Welcome join_with(SessionId session, std::uint8_t who,
                    std::uint64_t features = kFeatureMaterials) {
    const auto [h, welcome] = greet(session, who, features);
    server.received(session, client_auth(who, h, welcome), now());
    REQUIRE(environment.messages<SessionAccepted>(session, kEdge).size() == 1);
    return welcome;
  }
};

}  // namespace runstone::test
