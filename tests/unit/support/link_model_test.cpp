// The model of a link must behave like a link of that rate, delay and queue. The tests run in
// virtual time.
#include "tests/support/net/link_model.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr TimeNs kMs = 1'000'000;

LinkProfile plain(TimeNs round_trip_ns, std::uint64_t bits_per_second) {
  return {"plain", round_trip_ns, 0, bits_per_second, 0};
}

}  // namespace

TEST_CASE("the link profiles of the testbed have the documented values", "[link]") {
  REQUIRE(link_profiles().size() == 5);
  CHECK(link_profiles()[0].passes_all());
  const LinkProfile* mobile = find_link_profile("mobile");
  REQUIRE(mobile != nullptr);
  CHECK(mobile->round_trip_ns == 120 * kMs);
  CHECK(mobile->jitter_ns == 20 * kMs);
  CHECK(mobile->bits_per_second == 5'000'000);
  CHECK(mobile->queue_bytes() == 75'000);
  CHECK(find_link_profile("broadband")->queue_bytes() == 250'000);
  CHECK(find_link_profile("lan")->queue_bytes() == 65'536);
  CHECK(find_link_profile("lossy")->loss == 0.02);
  CHECK(find_link_profile("carrier pigeon") == nullptr);
  for (const LinkProfile& profile : link_profiles())
    CHECK(profile.jitter_ns <= profile.round_trip_ns / 2);
}

TEST_CASE("a link without rate, delay and loss passes everything at once", "[link]") {
  LinkModel link(link_profiles()[0], 1);
  for (TimeNs now = 0; now < 1000; ++now) {
    const LinkPassage passage = link.push(1'000'000, now);
    REQUIRE(passage.fate == LinkFate::arrives);
    REQUIRE(passage.due_ns == now);
    REQUIRE(link.queued_bytes(now) == 0);
  }
}

TEST_CASE("a packet alone takes its time at the transmitter and half a round trip", "[link]") {
  LinkModel link(plain(40 * kMs, 8'000'000), 1);  // a byte a microsecond
  CHECK(link.push(1000, 5 * kMs).due_ns == 5 * kMs + 1 * kMs + 20 * kMs);
  // One second later the transmitter is free.
  CHECK(link.push(500, 1000 * kMs).due_ns == 1000 * kMs + kMs / 2 + 20 * kMs);
}

TEST_CASE("packets that come together leave one after another", "[link]") {
  LinkModel link(plain(10 * kMs, 8'000'000), 1);
  for (TimeNs i = 1; i <= 10; ++i) CHECK(link.push(1000, 0).due_ns == i * kMs + 5 * kMs);
  CHECK(link.queued_bytes(0) == 10'000);
  CHECK(link.queued_bytes(4 * kMs) == 6'000);
  CHECK(link.queued_bytes(10 * kMs) == 0);
}

TEST_CASE("a packet that finds the queue full is dropped, and the queue empties at the link's rate",
          "[link]") {
  LinkModel link(plain(10 * kMs, 8'000'000), 1);  // a queue of 65,536 bytes
  int passed = 0;
  while (link.push(1000, 0).fate == LinkFate::arrives) ++passed;
  CHECK(passed == 65);
  CHECK(link.counts().no_room == 1);
  CHECK(link.push(1000, 0).fate == LinkFate::no_room);
  CHECK(link.push(1000, kMs).fate == LinkFate::arrives);
  CHECK(link.push(1000, kMs).fate == LinkFate::no_room);
  CHECK(link.counts().packets == 66);
  CHECK(link.counts().bytes == 66'000);
}

TEST_CASE("a packet larger than the queue passes a link that is free", "[link]") {
  LinkModel link(plain(0, 8'000'000), 1);
  CHECK(link.push(100'000, 0).fate == LinkFate::arrives);
  CHECK(link.push(1, 0).fate == LinkFate::no_room);
}

TEST_CASE("jitter stays in its bounds, reaches both of them, and never reorders", "[link]") {
  const LinkProfile profile{"jitter", 120 * kMs, 20 * kMs, 0, 0};
  LinkModel link(profile, Catch::rngSeed() + 1);
  TimeNs before = 0, shortest = 1000 * kMs, longest = 0;
  for (TimeNs i = 0; i < 2000; ++i) {
    const TimeNs now = i * 100 * kMs;  // so far apart that no packet waits for another
    const TimeNs due = link.push(100, now).due_ns;
    shortest = std::min(shortest, due - now);
    longest = std::max(longest, due - now);
    REQUIRE(due >= before);
    before = due;
  }
  CHECK(shortest >= 40 * kMs);
  CHECK(longest <= 80 * kMs);
  CHECK(shortest < 41 * kMs);
  CHECK(longest > 79 * kMs);
  const TimeNs start = 1'000'000 * kMs;
  for (TimeNs i = 0; i < 2000; ++i) {
    const TimeNs now = start + i * kMs / 10;
    const TimeNs due = link.push(100, now).due_ns;
    REQUIRE(due >= before);
    REQUIRE(due - now <= 80 * kMs);
    before = due;
  }
}

TEST_CASE("loss has the given share, uses the transmitter's time, and depends on the seed",
          "[link]") {
  const LinkProfile profile{"loss", 0, 0, 8'000'000, 0.02};
  const auto fates = [&](std::uint64_t seed) {
    LinkModel link(profile, seed);
    std::vector<bool> lost;
    for (TimeNs i = 0; i < 50'000; ++i) {
      const LinkPassage passage = link.push(1000, i * kMs);
      REQUIRE(passage.due_ns == (i + 1) * kMs);
      lost.push_back(passage.fate == LinkFate::lost);
    }
    CHECK(link.counts().lost + link.counts().packets == 50'000);
    return lost;
  };
  const std::vector<bool> first = fates(7);
  const auto share = static_cast<double>(std::count(first.begin(), first.end(), true)) / 50'000;
  CHECK(share == Approx(0.02).margin(0.004));
  CHECK(first == fates(7));
  CHECK(first != fates(8));
}
