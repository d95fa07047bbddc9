#include "server/interest/interest.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "common/core/hash.hpp"
#include "tests/support/codec/view_distance.hpp"

namespace runstone {
namespace {

using test::distance2;

constexpr CoordLimit kLimit{1000};

ChunkKey key_of(std::int32_t x, std::int32_t y, std::int32_t z) { return {0, {x, y, z}}; }

/// The definition: tries every chunk near the view.
std::set<ChunkCoord> cells_by_trying(const View& view, CoordLimit limit) {
  std::set<ChunkCoord> cells;
  for (std::int32_t x = view.centre.x - 12; x <= view.centre.x + 12; ++x) {
    for (std::int32_t y = view.centre.y - 12; y <= view.centre.y + 12; ++y) {
      for (std::int32_t z = view.centre.z - 12; z <= view.centre.z + 12; ++z) {
        if (view.contains({x, y, z}) && limit.contains({x, y, z})) cells.insert({x, y, z});
      }
    }
  }
  return cells;
}

TEST_CASE("a view difference is exactly the chunks of one view outside of the other",
          "[interest][property]") {
  SplitMix64 rng(Catch::rngSeed());
  const auto random_view = [&] {
    return View{1,
                {rng.between(-6, 6), rng.between(-6, 6), rng.between(-6, 6)},
                static_cast<std::uint8_t>(rng.below(7)),
                static_cast<std::uint8_t>(rng.below(5))};
  };
  for (int step = 0; step < 300; ++step) {
    const View a = random_view();
    const View b = random_view();
    const CoordLimit limit{step % 3 == 0 ? 5 : 1000};
    CAPTURE(Catch::rngSeed(), step);
    std::vector<ChunkCoord> found;
    append_difference(a, b, limit, found);
    std::set<ChunkCoord> expected = cells_by_trying(a, limit);
    for (const ChunkCoord& c : cells_by_trying(b, limit)) expected.erase(c);
    REQUIRE(std::set<ChunkCoord>(found.begin(), found.end()) == expected);
    REQUIRE(found.size() == expected.size());

    std::vector<ChunkCoord> all;
    append_difference(a, std::nullopt, limit, all);
    REQUIRE(all.size() == cells_by_trying(a, limit).size());
    REQUIRE(all.size() == chunks_in(a, limit));
  }
}

TEST_CASE("a view at the border of the world ends there and does not overflow", "[interest]") {
  const CoordLimit limit{kWorldLimit / 16};
  std::vector<ChunkCoord> cells;
  append_difference({1, {INT32_MAX, INT32_MIN, INT32_MAX}, 64, 64}, std::nullopt, limit, cells);
  CHECK(cells.empty());
  CHECK(chunks_in({1, {INT32_MAX, INT32_MIN, INT32_MAX}, 64, 64}, limit) == 0);
  append_difference({1, {limit.limit - 1, 0, 0}, 1, 0}, std::nullopt, limit, cells);
  CHECK(cells.size() == 4);  // the fifth would lie outside
}

TEST_CASE("a place names its chunk, also at the largest radius and at the ends of coordinates",
          "[interest]") {
  constexpr std::int32_t kRadius = 255;
  for (const std::int32_t centre : {0, INT32_MAX - kRadius, -INT32_MAX + kRadius}) {
    View view{1, {centre, -centre, centre}, kRadius, kRadius};
    view.cone = 8'192;
    const ViewOrder order(view);
    for (const std::int32_t x : {-kRadius, -1, 0, kRadius}) {
      for (const std::int32_t y : {-kRadius, 0, 1, kRadius}) {
        const ChunkCoord at{centre + x, -centre + y, centre - x};
        CHECK(order.chunk_at(order.place_of(at)) == at);
      }
    }
  }
}

TEST_CASE("wanted chunks come nearest first, with ties by key", "[interest]") {
  Interest interest(kLimit);
  interest.open(1);
  const View view{1, {3, -2, 5}, 5, 3};
  interest.set_view(1, view);
  std::vector<ChunkKey> order;
  while (const auto key = interest.nearest_wanted(1)) {
    order.push_back(*key);
    REQUIRE(interest.set_state(1, *key, ChunkInterest::subscribed));
  }
  REQUIRE(order.size() == cells_by_trying(view, kLimit).size());
  CHECK(order.front() == ChunkKey{0, view.centre});
  CHECK(std::is_sorted(order.begin(), order.end(), [&](const ChunkKey& a, const ChunkKey& b) {
    const auto da = distance2(view, a.at);
    const auto db = distance2(view, b.at);
    return da != db ? da < db : a < b;
  }));
}

TEST_CASE("chunks around the viewer come first, then those in the cone of sight, then the rest",
          "[interest]") {
  Interest interest(kLimit);
  interest.open(1);
  View view{1, {0, 0, 0}, 6, 2};
  view.yaw = 16'384;  // along +x
  view.cone = 8'192;  // 45 degrees to each side
  interest.set_view(1, view);
  std::vector<ChunkKey> order;
  while (const auto key = interest.nearest_wanted(1)) {
    order.push_back(*key);
    interest.set_state(1, *key, ChunkInterest::subscribed);
  }
  REQUIRE(order.size() == cells_by_trying(view, kLimit).size());
  const auto ring = [&](const ChunkKey& key) {
    const ChunkCoord c = key.at;
    if (distance2(view, c) <= 4) return 0;
    return c.x >= 0 && c.x * c.x * 2 >= distance2(view, c) ? 1 : 2;  // cos(45 degrees)^2 is a half
  };
  // Chunks exactly on the cone depend on rounding.
  std::erase_if(order, [](const ChunkKey& key) {
    const ChunkCoord c = key.at;
    return c.x * c.x == c.y * c.y + c.z * c.z;
  });
  CHECK(std::is_sorted(order.begin(), order.end(), [&](const ChunkKey& a, const ChunkKey& b) {
    if (ring(a) != ring(b)) return ring(a) < ring(b);
    const auto da = distance2(view, a.at);
    const auto db = distance2(view, b.at);
    return da != db ? da < db : a < b;
  }));
}

TEST_CASE("a view that only turns changes the order of wanted chunks, and nothing is sent again",
          "[interest]") {
  SessionInterest interest(kLimit);
  View view{1, {0, 0, 0}, 12, 4};
  interest.set_view(view);
  for (int i = 0; i < 500; ++i)
    interest.set_state(*interest.nearest_wanted(), ChunkInterest::subscribed);
  const std::size_t wanted = cells_by_trying(view, kLimit).size() - 500;
  view.yaw = 16'384;  // along +x
  view.cone = 4'096;
  const auto moved = interest.set_view(view);
  CHECK(moved.left.empty());
  CHECK(moved.steps <= wanted);
  CHECK(interest.count(ChunkInterest::subscribed) == 500);
  const ChunkKey first = *interest.nearest_wanted();
  CHECK(first.at.x > 0);
  CHECK(4 * (first.at.y * first.at.y + first.at.z * first.at.z) <= first.at.x * first.at.x);
}

TEST_CASE("a moved view costs the chunks that change and those that are wanted, not the whole view",
          "[interest]") {
  SessionInterest interest(kLimit);
  constexpr std::uint8_t kRadius = 16;
  interest.set_view({1, {0, 0, 0}, kRadius, kRadius});
  while (const auto key = interest.nearest_wanted())
    interest.set_state(*key, ChunkInterest::subscribed);
  const std::size_t all = interest.chunks().size();
  const auto moved = interest.set_view({1, {1, 0, 0}, kRadius, kRadius});
  CHECK(moved.steps == 2 * moved.left.size());  // as many entered
  CHECK(moved.steps < all / 10);
  while (const auto key = interest.nearest_wanted())
    interest.set_state(*key, ChunkInterest::subscribed);
  CHECK(interest.set_view({1, {1, 0, 0}, kRadius, kRadius}).steps == 0);
}

TEST_CASE("a moved view makes only new chunks wanted and releases the chunks that it left",
          "[interest]") {
  Interest interest(kLimit);
  interest.open(1);
  interest.set_view(1, {1, {0, 0, 0}, 8, 2});
  while (const auto key = interest.nearest_wanted(1))
    interest.set_state(1, *key, ChunkInterest::subscribed);
  const std::size_t all = interest.find(1)->chunks().size();
  CHECK(interest.take_released(1'000).empty());

  interest.set_view(1, {1, {1, 0, 0}, 8, 2});
  const SessionInterest& mine = *interest.find(1);
  const std::size_t shell = 17 * 5;  // one new chunk per row of the disc and height
  CHECK(mine.count(ChunkInterest::subscribed) == all - shell);
  CHECK(interest.take_released(1'000).size() == shell);
  CHECK_FALSE(interest.subscribes(1, key_of(-8, 0, 0)));
  CHECK(interest.nearest_wanted(1) != key_of(9, 2, 0));
  std::size_t wanted = 0;
  while (const auto key = interest.nearest_wanted(1)) {
    interest.set_state(1, *key, ChunkInterest::waiting);
    ++wanted;
  }
  CHECK(wanted == shell);
}

TEST_CASE("subscribers of a chunk are the sessions that got it, until they leave", "[interest]") {
  Interest interest(kLimit);
  for (const SessionId session : {7U, 3U, 5U}) {
    interest.open(session);
    interest.set_view(session, {1, {0, 0, 0}, 1, 1});
  }
  const ChunkKey key = key_of(0, 1, 0);
  interest.set_state(7, key, ChunkInterest::subscribed);
  interest.set_state(3, key, ChunkInterest::waiting);
  CHECK(std::vector<SessionId>(interest.subscribers(key).begin(),
                               interest.subscribers(key).end()) == std::vector<SessionId>{7});
  CHECK(interest.waiting(key) == std::vector<SessionId>{3});
  interest.set_state(3, key, ChunkInterest::subscribed);
  CHECK(
      std::vector<SessionId>(interest.subscribers(key).begin(), interest.subscribers(key).end()) ==
      std::vector<SessionId>{3, 7});  // ascending, not in the order of subscription
  CHECK(interest.waiting(key).empty());
  CHECK_FALSE(interest.set_state(5, key_of(9, 9, 9), ChunkInterest::subscribed));

  interest.close(7);
  CHECK(interest.take_released(1'000).empty());
  interest.set_state(3, key, ChunkInterest::wanted);  // stale
  CHECK(interest.take_released(1'000) == std::vector<ChunkKey>{key});
  CHECK(interest.subscribers(key).empty());
  CHECK_FALSE(interest.is_used(key));
  CHECK(interest.nearest_wanted(3) == key_of(0, 0, 0));
  interest.close(3);
  interest.close(99);  // unknown keys are ignored
}

TEST_CASE("digest checks visit all subscribed chunks in turn and no others", "[interest]") {
  Interest interest(kLimit);
  interest.open(1);
  CHECK_FALSE(interest.next_for_digest_check(1).has_value());
  interest.set_view(1, {1, {0, 0, 0}, 2, 0});
  std::set<ChunkKey> subscribed;
  for (int i = 0; i < 6; ++i) {
    const ChunkKey key = *interest.nearest_wanted(1);
    interest.set_state(1, key, ChunkInterest::subscribed);
    subscribed.insert(key);
  }
  std::set<ChunkKey> seen;
  for (int i = 0; i < 6; ++i) seen.insert(*interest.next_for_digest_check(1));
  CHECK(seen == subscribed);
}

TEST_CASE("random views and states keep users and states consistent", "[interest][property]") {
  SplitMix64 rng(Catch::rngSeed() + 1);
  Interest interest(kLimit);
  for (SessionId s = 1; s <= 4; ++s) interest.open(s);
  for (int step = 0; step < 3000; ++step) {
    const SessionId session = 1 + rng.below(4);
    if (rng.below(20) == 0) {
      interest.set_view(session, {1,
                                  {rng.between(-3, 3), rng.between(-1, 1), rng.between(-3, 3)},
                                  static_cast<std::uint8_t>(rng.below(4)),
                                  static_cast<std::uint8_t>(rng.below(2))});
    } else {
      const ChunkKey key{0, {rng.between(-5, 5), rng.between(-2, 2), rng.between(-5, 5)}};
      interest.set_state(session, key, static_cast<ChunkInterest>(rng.below(4)));
    }
    if (step % 50 != 0) continue;
    for (SessionId s = 1; s <= 4; ++s) {
      std::size_t subscribed = 0;
      for (const auto& [key, state] : interest.find(s)->chunks()) {
        const auto users = interest.subscribers(key);
        REQUIRE(std::ranges::is_sorted(users));
        const auto waiting = interest.waiting(key);
        REQUIRE((std::find(users.begin(), users.end(), s) != users.end()) ==
                (state == ChunkInterest::subscribed));
        REQUIRE((std::find(waiting.begin(), waiting.end(), s) != waiting.end()) ==
                (state == ChunkInterest::waiting));
        subscribed += state == ChunkInterest::subscribed ? 1 : 0;
      }
      REQUIRE(interest.find(s)->count(ChunkInterest::subscribed) == subscribed);
      std::optional<ChunkKey> expected;  // the definition: tries every chunk near the views
      const auto view = interest.find(s)->view();
      for (std::int32_t x = -6; x <= 6; ++x) {
        for (std::int32_t y = -2; y <= 2; ++y) {
          for (std::int32_t z = -6; z <= 6; ++z) {
            const ChunkKey key = key_of(x, y, z);
            const auto state = interest.find(s)->state(key);
            REQUIRE(state.has_value() == (view && view->contains(key.at)));
            if (state != ChunkInterest::wanted) continue;
            const auto rank = [&](const ChunkKey& k) {
              return std::pair(distance2(*view, k.at), k);
            };
            if (!expected || rank(key) < rank(*expected)) expected = key;
          }
        }
      }
      REQUIRE(interest.nearest_wanted(s) == expected);
    }
  }
}

}  // namespace
}  // namespace runstone
