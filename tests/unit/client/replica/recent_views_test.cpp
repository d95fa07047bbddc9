#include "client/replica/recent_views.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr ChunkKey kHere{0, {0, 0, 0}};
constexpr ChunkKey kRight{0, {1, 0, 0}};

/// Makes a view of the chunks at x and beside it.
View at(std::uint32_t number, std::int32_t x) { return {number, {x, 0, 0}, 1, 0}; }

}  // namespace

TEST_CASE("before the first view no answer counts", "[replica]") {
  RecentViews views;
  CHECK_FALSE(views.contains(kHere));
  CHECK_FALSE(views.accepts(kHere, 1));
}

TEST_CASE("an answer from before the chunk left the view does not count when it is back",
          "[replica]") {
  RecentViews views;
  views.set(at(1, 0));
  CHECK(views.accepts(kHere, 1));
  views.set(at(2, 2));  // kHere leaves, kRight stays
  CHECK_FALSE(views.accepts(kHere, 1));
  CHECK_FALSE(views.accepts(kHere, 2));
  CHECK(views.accepts(kRight, 1));
  views.set(at(3, 1));
  CHECK(views.contains(kHere));
  CHECK_FALSE(views.accepts(kHere, 1));
  CHECK_FALSE(views.accepts(kHere, 2));  // the server cannot have answered it
  CHECK(views.accepts(kHere, 3));
  CHECK(views.accepts(kRight, 1));
  views.set(at(4, 0));
  CHECK_FALSE(views.accepts(kHere, 2));
  CHECK(views.accepts(kHere, 3));
}

TEST_CASE("views that differ in the direction only keep their chunks", "[replica]") {
  RecentViews views;
  views.set(at(1, 5));
  for (std::uint32_t number = 2; number < 10 + kRecentViewsMax; ++number) {
    View turned = at(number, 0);
    turned.yaw = static_cast<std::uint16_t>(number);
    views.set(turned);
    REQUIRE(views.current() == turned);
  }
  CHECK_FALSE(views.accepts(kHere, 1));
  CHECK(views.accepts(kHere, 2));
}

TEST_CASE("a view that was replaced before it was sent is forgotten", "[replica]") {
  RecentViews views;
  views.set(at(1, 9));
  views.set(at(1, 0));
  CHECK(views.accepts(kHere, 1));
  views.set(at(2, 9));
  views.set(at(2, 1));
  CHECK(views.accepts(kHere, 1));
}

TEST_CASE("a new connection counts views from 1 again", "[replica]") {
  RecentViews views;
  views.set(at(7, 9));
  views.set(at(8, 0));
  views.reopen();
  CHECK(views.accepts(kHere, 1));
  views.set(at(2, 9));
  views.set(at(3, 0));
  CHECK_FALSE(views.accepts(kHere, 1));
  CHECK(views.accepts(kHere, 3));
}

TEST_CASE("the views that are remembered are bounded", "[replica]") {
  RecentViews views;
  views.set(at(1, 9));
  const auto newest = static_cast<std::uint32_t>(kRecentViewsMax + 2);
  for (std::uint32_t number = 2; number <= newest; ++number)
    views.set(at(number, static_cast<std::int32_t>(number % 2)));
  CHECK(views.accepts(kHere, 2));
  CHECK(views.accepts(kHere, 1));  // forgotten, so that the versions decide
}

TEST_CASE("no chunk of another level of detail is in view", "[replica]") {
  RecentViews views;
  views.set(at(1, 0));
  CHECK_FALSE(views.accepts({1, {0, 0, 0}}, 1));
}
