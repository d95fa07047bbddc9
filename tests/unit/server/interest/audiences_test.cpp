#include "server/interest/audiences.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "common/core/hash.hpp"

namespace runstone {
namespace {

using Receivers = std::vector<std::vector<SessionId>>;

TEST_CASE("edits with the same receivers are one audience", "[interest]") {
  CHECK(audiences_of({}).empty());
  CHECK(audiences_of({{}, {}}).empty());
  CHECK(audiences_of({{3, 7}, {}, {3, 7}, {3, 7}}) == std::vector<Audience>{{{3, 7}, {0, 2, 3}}});
}

TEST_CASE("sessions share an audience exactly if they get the same edits", "[interest]") {
  // Session 1 gets edits 0 and 2, session 2 all, session 3 edits 1 and 2, session 4 as session 1.
  const Receivers receivers = {{1, 2, 4}, {2, 3}, {1, 2, 3, 4}};
  CHECK(audiences_of(receivers) ==
        std::vector<Audience>{{{1, 4}, {0, 2}}, {{2}, {0, 1, 2}}, {{3}, {1, 2}}});
}

TEST_CASE("every session is in one audience, with exactly its edits", "[interest][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int step = 0; step < 200; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    Receivers receivers(rng.below(200));
    std::map<SessionId, std::vector<std::uint32_t>> expected;
    for (std::uint32_t i = 0; i < receivers.size(); ++i) {
      if (i > 0 && rng.below(3) != 0) {
        receivers[i] = receivers[rng.below(i)];
      } else {
        for (SessionId s = 1; s <= 30; ++s) {
          if (rng.below(3) == 0) receivers[i].push_back(s);
        }
      }
      for (const SessionId s : receivers[i]) expected[s].push_back(i);
    }
    std::map<SessionId, std::vector<std::uint32_t>> got;
    const std::vector<Audience> audiences = audiences_of(receivers);
    for (const Audience& audience : audiences) {
      CHECK(std::ranges::is_sorted(audience.sessions));
      for (const SessionId s : audience.sessions) CHECK(got.emplace(s, audience.edits).second);
    }
    CHECK(got == expected);
    for (std::size_t a = 0; a < audiences.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) CHECK(audiences[a].edits != audiences[b].edits);
    }
  }
}

}  // namespace
}  // namespace runstone
