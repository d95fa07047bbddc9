#include "server/world/ground/load_queue.hpp"

#include <catch2/catch.hpp>
#include <optional>
#include <set>
#include <vector>

namespace runstone {
namespace {

ChunkKey key_of(std::int32_t x) { return {0, {x, 0, 0}}; }

std::optional<ChunkKey> next_key(LoadQueue& queue, const std::set<SessionId>& must_wait = {}) {
  const auto next = queue.next(must_wait);
  return next ? std::optional(next->key) : std::nullopt;
}

/// Returns all keys in the order in which they are loaded, as if each load ended at once.
std::vector<std::int32_t> load_order(LoadQueue& queue) {
  std::vector<std::int32_t> order;
  while (const auto key = next_key(queue)) order.push_back(key->at.x);
  return order;
}

TEST_CASE("sessions are served in turn, each in its own order, and the world like one more session",
          "[world]") {
  LoadQueue queue(1);
  for (const std::int32_t x : {13, 11, 12}) queue.request(1, key_of(x));
  for (const std::int32_t x : {22, 21}) queue.request(2, key_of(x));
  for (const std::int32_t x : {2, 1, 2}) queue.request_for_world(key_of(x));
  CHECK(load_order(queue) == std::vector<std::int32_t>{13, 22, 1, 11, 21, 2, 12});
  CHECK(load_order(queue).empty());
}

TEST_CASE("a session with many requests delays another session by one load", "[world]") {
  LoadQueue queue(1);
  for (std::int32_t x = 0; x < 50; ++x) queue.request(7, key_of(x));
  REQUIRE(next_key(queue) == key_of(0));
  queue.request(3, key_of(100));
  queue.request(9, key_of(101));
  CHECK(next_key(queue) == key_of(101));
  CHECK(next_key(queue) == key_of(100));
  CHECK(next_key(queue) == key_of(1));
}

TEST_CASE("a key that is put back is the next one of its session", "[world]") {
  LoadQueue queue(1);
  for (const std::int32_t x : {13, 11, 12}) queue.request(1, key_of(x));
  const auto next = queue.next();
  REQUIRE(next.has_value());
  CHECK(next->session == SessionId{1});
  queue.put_back(1, next->key);
  CHECK(load_order(queue) == std::vector<std::int32_t>{13, 11, 12});
}

TEST_CASE("at most the allowed number of loads is under way", "[world]") {
  LoadQueue queue(2);
  for (std::int32_t x = 0; x < 5; ++x) queue.request(1, key_of(x));
  REQUIRE(queue.next());
  queue.load_started();
  REQUIRE(queue.next());
  queue.load_started();
  CHECK_FALSE(queue.next());
  queue.load_ended();
  CHECK(next_key(queue) == key_of(2));
}

TEST_CASE("sessions that must wait are skipped, and the world is not", "[world]") {
  LoadQueue queue(1);
  for (const SessionId session : {1U, 2U, 3U}) {
    queue.request(session, key_of(static_cast<std::int32_t>(session * 10)));
    queue.request(session, key_of(static_cast<std::int32_t>(session * 10 + 1)));
  }
  queue.request_for_world(key_of(1));
  queue.request_for_world(key_of(2));
  const auto for_world = queue.next_for_world();
  REQUIRE(for_world.has_value());
  CHECK(for_world->key == key_of(1));
  CHECK_FALSE(for_world->session.has_value());
  const std::set<SessionId> must_wait{1, 3};
  CHECK(next_key(queue, must_wait) == key_of(20));
  CHECK(next_key(queue, must_wait) == key_of(2));
  CHECK(next_key(queue, must_wait) == key_of(21));
  CHECK_FALSE(queue.next(must_wait));
  CHECK_FALSE(queue.next_for_world());
  CHECK(load_order(queue) == std::vector<std::int32_t>{10, 30, 11, 31});
}

TEST_CASE("keys that only the world needs are cancelled together", "[world]") {
  LoadQueue queue(1);
  queue.request(1, key_of(1));
  for (std::int32_t x = 0; x < 3; ++x) queue.request_for_world(key_of(x));
  queue.cancel_for_world();
  CHECK(load_order(queue) == std::vector<std::int32_t>{1});
}

TEST_CASE("a cancelled key is not loaded", "[world]") {
  LoadQueue queue(1);
  for (std::int32_t x = 0; x < 3; ++x) queue.request(1, key_of(x));
  queue.request(2, key_of(1));
  queue.cancel(1, key_of(1));
  queue.cancel(5, key_of(1));  // unknown keys are ignored
  CHECK(queue.cancel(1) == std::vector<ChunkKey>{key_of(0), key_of(2)});
  CHECK(load_order(queue) == std::vector<std::int32_t>{1});  // the other session still waits for it
}

}  // namespace
}  // namespace runstone
