#include "server/world/load_queue.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

ChunkKey key_of(std::int32_t x) { return {0, {x, 0, 0}}; }

/// All keys in the order of their turns, as if each load ended at once.
std::vector<std::int32_t> turns(LoadQueue& queue) {
  std::vector<std::int32_t> order;
  while (const auto key = queue.next()) order.push_back(key->at.x);
  return order;
}

TEST_CASE("sessions take turns, each in its own order, and the world like one more session",
          "[world]") {
  LoadQueue queue(1);
  for (const std::int32_t x : {13, 11, 12}) queue.ask(1, key_of(x));
  for (const std::int32_t x : {22, 21}) queue.ask(2, key_of(x));
  for (const std::int32_t x : {2, 1, 2}) queue.ask_own(key_of(x));
  CHECK(turns(queue) == std::vector<std::int32_t>{13, 22, 1, 11, 21, 2, 12});
  CHECK(turns(queue).empty());
}

TEST_CASE("a session that asks for much delays one that asks for little by one turn", "[world]") {
  LoadQueue queue(1);
  for (std::int32_t x = 0; x < 50; ++x) queue.ask(7, key_of(x));
  REQUIRE(queue.next() == key_of(0));
  queue.ask(3, key_of(100));
  queue.ask(9, key_of(101));
  CHECK(queue.next() == key_of(101));
  CHECK(queue.next() == key_of(100));
  CHECK(queue.next() == key_of(1));
}

TEST_CASE("no more loads are under way than allowed", "[world]") {
  LoadQueue queue(2);
  for (std::int32_t x = 0; x < 5; ++x) queue.ask(1, key_of(x));
  REQUIRE(queue.next());
  queue.began();
  REQUIRE(queue.next());
  queue.began();
  CHECK_FALSE(queue.next());
  queue.ended();
  CHECK(queue.next() == key_of(2));
}

TEST_CASE("what is taken back has no turn", "[world]") {
  LoadQueue queue(1);
  for (std::int32_t x = 0; x < 3; ++x) queue.ask(1, key_of(x));
  queue.ask(2, key_of(1));
  queue.take_back(1, key_of(1));
  queue.take_back(5, key_of(1));  // unknown: allowed
  CHECK(queue.take_back(1) == std::vector<ChunkKey>{key_of(0), key_of(2)});
  CHECK(turns(queue) == std::vector<std::int32_t>{1});  // the other session still waits for it
}

}  // namespace
}  // namespace runstone
