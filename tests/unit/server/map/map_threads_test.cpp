#include "server/map/map_threads.hpp"

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <latch>
#include <thread>

using namespace runstone;

namespace {

/// A map with so many turns to do. It notices turns that overlap.
class CountingMap final : public MapThreads::Map {
 public:
  explicit CountingMap(int count) : left_(count) {}
  bool turn() override {
    if (is_in_turn_.exchange(true)) overlaps = true;
    const int left = --left_;
    ++turns;
    is_in_turn_ = false;
    if (left == 0) done.count_down();
    return left > 0;
  }
  std::atomic<int> turns{0};
  std::atomic<bool> overlaps{false};
  std::latch done{1};

 private:
  std::atomic<int> left_;
  std::atomic<bool> is_in_turn_{false};
};

/// A map whose turns wait until the test lets them end.
class BlockedMap final : public MapThreads::Map {
 public:
  bool turn() override {
    ++turns;
    begun.count_down();
    may_end.wait();
    return has_more;
  }
  std::atomic<int> turns{0};
  std::latch begun{1}, may_end{1};
  bool has_more = false;
};

}  // namespace

TEST_CASE("each map gets all of its turns, one at a time", "[map]") {
  MapThreads threads(3);
  std::array<CountingMap, 4> maps{CountingMap(300), CountingMap(1), CountingMap(40),
                                  CountingMap(300)};
  for (CountingMap& map : maps) {
    threads.wake(map);
    threads.wake(map);
  }
  for (CountingMap& map : maps) map.done.wait();
  for (CountingMap& map : maps) {
    threads.leave(map);
    CHECK_FALSE(map.overlaps);
  }
  CHECK(maps[0].turns >= 300);
}

TEST_CASE("maps take turns in order, so that one with much to do delays the others by one turn",
          "[map]") {
  MapThreads threads(1);
  BlockedMap first;
  CountingMap large(1'000'000), small(2);
  threads.wake(first);
  first.begun.wait();
  threads.wake(large);
  threads.wake(small);
  first.may_end.count_down();
  small.done.wait();
  CHECK(large.turns < 1'000'000);
  threads.leave(large);
  threads.leave(small);
  threads.leave(first);
}

TEST_CASE("a map that has left gets no turn, and the others go on", "[map]") {
  MapThreads threads(1);
  BlockedMap running;
  running.has_more = true;
  CountingMap waiting(5), other(5);
  threads.wake(running);
  running.begun.wait();
  threads.wake(waiting);
  threads.wake(other);
  threads.leave(waiting);
  CHECK(waiting.turns == 0);
  std::thread leaver([&] { threads.leave(running); });
  running.may_end.count_down();
  leaver.join();
  const int turns = running.turns;
  other.done.wait();
  CHECK(running.turns == turns);
  threads.leave(other);
  CHECK(waiting.turns == 0);
}

TEST_CASE("a call during the last turn of a map gives it one more", "[map]") {
  MapThreads threads(1);
  BlockedMap map;
  threads.wake(map);
  map.begun.wait();
  threads.wake(map);
  CountingMap behind(1);
  threads.wake(behind);
  map.may_end.count_down();
  behind.done.wait();
  CountingMap last(1);
  threads.wake(last);
  last.done.wait();
  CHECK(map.turns == 2);
  for (MapThreads::Map* each :
       {static_cast<MapThreads::Map*>(&map), static_cast<MapThreads::Map*>(&behind),
        static_cast<MapThreads::Map*>(&last)})
    threads.leave(*each);
}
