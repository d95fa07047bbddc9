#include "server/world/ground/tile_queue.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

constexpr ChunkKey kCoarse{4, {0, 0, 0}}, kFine{1, {0, 0, 0}}, kFine2{1, {1, 0, 0}};
constexpr std::size_t kAll = 100;

}  // namespace

TEST_CASE("the coarsest tile is made first, then the earliest request") {
  TileQueue queue;
  queue.want(kFine2, 1);
  queue.want(kFine, 1);
  queue.want(kCoarse, 2);
  queue.want(kFine, 3);
  CHECK(queue.next(0, kAll) == kCoarse);
  CHECK(queue.next(0, kAll) == kFine2);
  CHECK_FALSE(queue.next(0, 2).has_value());  // two are under way
  CHECK(queue.next(0, 3) == kFine);
  CHECK_FALSE(queue.next(0, kAll).has_value());
  CHECK(queue.finished(kFine) == std::vector<SessionId>{1, 3});
  CHECK(queue.in_flight() == 2);
}

TEST_CASE("changed tiles are held while they owe time, those that sessions wait for are not") {
  TileQueue queue;
  queue.make_again(kFine, 0);
  queue.charge_changed(0, 300);
  queue.charge_changed(0, 200);  // the costs add up
  CHECK_FALSE(queue.next(499, kAll).has_value());
  queue.want(kCoarse, 1);
  CHECK(queue.next(499, kAll) == kCoarse);
  CHECK(queue.next(500, kAll) == kFine);
}

TEST_CASE("changed tiles save the time of a tick and not more") {
  TileQueue queue;
  const TimeUs now = 10 * kChangedBurstUs;
  queue.make_again(kFine, 0);
  queue.make_again(kFine2, 0);
  queue.charge_changed(now, kChangedBurstUs);
  CHECK(queue.next(now, kAll) == kFine);
  queue.charge_changed(now, 1);
  CHECK_FALSE(queue.next(now, kAll).has_value());
  CHECK(queue.next(now + 1, kAll) == kFine2);
}

TEST_CASE("changed tiles come after those that sessions wait for, the longest due first") {
  TileQueue queue;
  queue.make_again(kFine, 20);
  queue.make_again(kFine2, 10);
  queue.make_again(kFine2, 90);  // it is due before
  queue.want(kCoarse, 1);
  CHECK(queue.next(5, kAll) == kCoarse);
  CHECK_FALSE(queue.next(5, kAll).has_value());
  CHECK(queue.next(25, kAll) == kFine2);
  CHECK(queue.next(25, kAll) == kFine);
  CHECK(queue.finished(kFine).empty());
}

TEST_CASE("a tile under way that changes is made once more, when it has finished") {
  TileQueue queue;
  queue.make_again(kFine, 0);
  CHECK(queue.next(0, kAll) == kFine);
  queue.make_again(kFine, 1);
  CHECK_FALSE(queue.next(1, kAll).has_value());
  queue.finished(kFine);
  CHECK(queue.next(1, kAll) == kFine);
}

TEST_CASE("a session that joins a tile under way gets it") {
  TileQueue queue;
  queue.want(kFine, 1);
  CHECK(queue.next(0, kAll) == kFine);
  queue.want(kFine, 2);
  CHECK_FALSE(queue.next(0, kAll).has_value());
  CHECK(queue.finished(kFine) == std::vector<SessionId>{1, 2});
}

TEST_CASE("a tile that nobody wants any more is not made") {
  TileQueue queue;
  queue.want(kFine, 1);
  queue.want(kFine, 2);
  queue.cancel(kFine, 1);
  CHECK(queue.is_waited_for(kFine));
  queue.cancel(kFine, 2);
  queue.cancel(kFine, 2);
  CHECK_FALSE(queue.is_waited_for(kFine));
  queue.make_again(kFine2, 0);
  queue.cancel_again(kFine2);
  CHECK(queue.count() == 0);
  CHECK_FALSE(queue.next(0, kAll).has_value());
}

TEST_CASE("a tile that could not be made is due again, and its sessions go on waiting") {
  TileQueue queue;
  queue.want(kFine, 1);
  CHECK(queue.next(0, kAll) == kFine);
  queue.failed(kFine, 50);
  queue.want(kFine, 2);
  CHECK_FALSE(queue.next(49, kAll).has_value());
  CHECK(queue.next(50, kAll) == kFine);
  CHECK(queue.finished(kFine) == std::vector<SessionId>{1, 2});
}

TEST_CASE("a tile that takes long has every second turn, and otherwise waits behind the others") {
  TileQueue queue;
  queue.want(kCoarse, 1);
  CHECK(queue.next(0, kAll) == kCoarse);
  queue.stopped(kCoarse, 0);
  CHECK(queue.stops(kCoarse) == 1);
  CHECK(queue.in_flight() == 0);
  CHECK(queue.is_waited_for(kCoarse));
  for (std::int32_t x = 0; x < 4; ++x) queue.want({1, {x, 0, 0}}, 2);
  std::vector<ChunkKey> order;
  while (const auto key = queue.next(0, kAll)) {
    order.push_back(*key);
    if (*key == kCoarse && queue.stops(kCoarse) < 3) {
      queue.stopped(kCoarse, 0);
    } else {
      queue.finished(*key);
    }
  }
  CHECK(order == std::vector<ChunkKey>{{1, {0, 0, 0}},
                                       kCoarse,
                                       {1, {1, 0, 0}},
                                       kCoarse,
                                       {1, {2, 0, 0}},
                                       kCoarse,
                                       {1, {3, 0, 0}}});
  CHECK(queue.stops(kCoarse) == 0);
}

TEST_CASE("a tile that has stopped is forgotten when nobody wants it any more") {
  TileQueue queue;
  queue.want(kCoarse, 1);
  CHECK(queue.next(0, kAll) == kCoarse);
  queue.stopped(kCoarse, 0);
  queue.cancel(kCoarse, 1);
  CHECK(queue.stops(kCoarse) == 0);
  CHECK_FALSE(queue.next(0, kAll).has_value());
  // One that was due after an edit is due again.
  queue.make_again(kFine, 0);
  CHECK(queue.next(0, kAll) == kFine);
  queue.stopped(kFine, 5);
  CHECK_FALSE(queue.next(4, kAll).has_value());
  CHECK(queue.next(5, kAll) == kFine);
  CHECK(queue.stops(kFine) == 1);
  queue.stopped(kFine, 5);
  queue.cancel_again(kFine);
  CHECK(queue.stops(kFine) == 0);
  CHECK(queue.count() == 0);
}

}  // namespace runstone::test
