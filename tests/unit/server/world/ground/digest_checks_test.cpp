#include "server/world/ground/digest_checks.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {

TEST_CASE("the digest checks of many sessions are spread over the ticks, one a second for each",
          "[world]") {
  WorldBench bench;
  constexpr std::uint8_t kPlayers = 40;
  for (SessionId id = 1; id <= kPlayers; ++id) {
    bench.join(id, static_cast<std::uint8_t>(id));
    bench.view(id, {1, {0, 0, 0}, 0, 0});
  }
  bench.tick();  // sends the checks that were due before the sessions joined
  const auto sent = [&] { return bench.server.counters().digest_checks_sent; };
  std::uint64_t before = sent();
  for (int second = 0; second < 3; ++second) {
    const std::uint64_t began = before;
    for (int i = 0; i < 20; ++i) {
      bench.tick(50'000);
      CHECK(sent() - before == 2);
      before = sent();
    }
    CHECK(sent() - began == kPlayers);
    for (SessionId id = 1; id <= kPlayers; ++id) {
      CHECK(bench.environment.messages<DigestCheck>(id, kEdge).size() ==
            static_cast<std::size_t>(second) + 2);
    }
  }
}

}  // namespace runstone::test
