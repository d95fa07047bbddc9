#include "client/stream/connect_order.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

#include "common/core/hash.hpp"

namespace runstone::test {
namespace {

using Order = ConnectOrder<std::string>;

constexpr ConnectPauses kPauses{100, 3'000};

/// Returns 0, so that every choice is the first one.
std::uint32_t lowest(std::uint32_t /*bound*/) { return 0; }
std::uint32_t highest(std::uint32_t bound) { return bound - 1; }

std::vector<std::string> addresses(Order& order, std::size_t count) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(order.next().address);
  return out;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("a single address is tried again after pauses that double", "[client_net]") {
  Order order({"a"}, kPauses, lowest);
  CHECK(order.next().pause_ms == 0);
  for (const std::int64_t pause_ms : {75, 150, 300, 600, 1'200, 2'250, 2'250}) {
    const Order::Attempt attempt = order.next();
    CHECK(attempt.address == "a");
    CHECK_FALSE(attempt.is_listed);
    CHECK(attempt.pause_ms == pause_ms);
  }
  order.connected();
  CHECK(order.next().pause_ms == 75);
  Order late({"a"}, kPauses, highest);
  late.next();
  CHECK(late.next().pause_ms == 125);
  CHECK(late.next().pause_ms == 250);
}

TEST_CASE("after a loss the others are tried first, then what the user gave", "[client_net]") {
  Order order({"given"}, kPauses, lowest);
  order.next();
  order.connected();
  order.set_others({"b", "c"});
  const Order::Attempt first = order.next();
  CHECK(first.address == "b");
  CHECK(first.is_listed);
  CHECK(first.pause_ms == 0);
  const Order::Attempt second = order.next();
  CHECK(second.address == "c");
  CHECK(second.pause_ms == 0);
  const Order::Attempt third = order.next();
  CHECK(third.address == "given");
  CHECK_FALSE(third.is_listed);
  const Order::Attempt again = order.next();
  CHECK(again.address == "b");
  CHECK(again.pause_ms == 75);  // a new round
  CHECK(addresses(order, 2) == Names{"c", "given"});
  CHECK(order.next().pause_ms == 150);
}

TEST_CASE("the first attempt at another server comes within a fifth of a second", "[client_net]") {
  Order order({"given"}, kPauses, highest);
  order.next();
  order.connected();
  order.set_others({"b", "c"});
  const Order::Attempt first = order.next();
  CHECK(first.address == "c");  // the last one
  CHECK(first.pause_ms == 199);
  const Order::Attempt second = order.next();
  CHECK(second.address == "b");
  CHECK(second.pause_ms == 99);
}

TEST_CASE("players of a server that ends spread over the others", "[client_net]") {
  SplitMix64 rng{1};
  std::multiset<std::string> first;
  for (int i = 0; i < 300; ++i) {
    Order order({"given"}, kPauses, [&rng](std::uint32_t bound) { return rng.below(bound); });
    order.next();
    order.connected();
    order.set_others({"b", "c", "d"});
    first.insert(order.next().address);
  }
  for (const char* name : {"b", "c", "d"}) CHECK(first.count(name) > 60);
}

TEST_CASE("a server of the list that was lost is tried last", "[client_net]") {
  Order order({"given"}, kPauses, lowest);
  order.next();
  order.connected();
  order.set_others({"b", "c"});
  CHECK(order.next().address == "b");
  order.connected();
  order.set_others({"a", "c"});  // as seen from b
  CHECK(addresses(order, 4) == Names{"a", "c", "given", "b"});
  CHECK(addresses(order, 4) == Names{"a", "c", "given", "b"});
}

TEST_CASE("a connection that brings no list does not begin again with the first address",
          "[client_net]") {
  Order order({"given"}, kPauses, lowest);
  order.next();
  order.connected();
  order.set_others({"b", "c"});
  CHECK(order.next().address == "b");
  order.connected();  // it is full, and says goodbye
  CHECK(order.next().address == "c");
  order.connected();
  CHECK(order.next().address == "given");
  order.connected();
  for (const std::int64_t pause_ms : {75, 150, 300}) {  // all of them are full
    const Order::Attempt attempt = order.next();
    CHECK(attempt.address == "b");
    CHECK(attempt.pause_ms == pause_ms);
    order.connected();
    CHECK(addresses(order, 2) == Names{"c", "given"});
    order.connected();
  }
  order.set_others({"b", "c"});
  CHECK(addresses(order, 3) == Names{"b", "c", "given"});
  CHECK(order.next().pause_ms == 75);
}

TEST_CASE("a newer list replaces the earlier one at the next attempt", "[client_net]") {
  Order order({"given"}, kPauses, lowest);
  order.next();
  order.connected();
  order.set_others({"b", "c"});
  order.set_others({"c", "d"});
  CHECK(addresses(order, 3) == Names{"c", "d", "given"});
  order.set_others({});
  const Order::Attempt next = order.next();
  CHECK(next.address == "given");
  CHECK(next.pause_ms == 75);
}

TEST_CASE("an address that the user gave stays one when a list has it too", "[client_net]") {
  Order order({"a", "b"}, kPauses, lowest);
  CHECK(order.next().address == "a");
  order.connected();
  order.set_others({"b", "c"});
  const Order::Attempt first = order.next();
  CHECK(first.address == "b");
  CHECK_FALSE(first.is_listed);
  CHECK(addresses(order, 2) == Names{"c", "a"});
  CHECK(addresses(order, 3) == Names{"b", "c", "a"});
}

TEST_CASE("of several given addresses a random one is the first", "[client_net]") {
  Order order({"a", "b", "c"}, kPauses, highest);
  CHECK(addresses(order, 3) == Names{"c", "a", "b"});
}

}  // namespace runstone::test
