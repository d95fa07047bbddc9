// The order in which the messages of sessions reach the world.
#include "server/runtime/message_turns.hpp"

#include <catch2/catch.hpp>
#include <utility>
#include <vector>

using namespace runstone;

namespace {

/// A session and the number in its ping.
using SentPing = std::pair<SessionId, TimeUs>;

SentPing ping_of(const MessageTurns::Turn& turn) {
  return {turn.session, std::get<Ping>(turn.message).sent_us};
}

std::vector<SentPing> all_turns(MessageTurns& turns) {
  std::vector<SentPing> out;
  while (const auto turn = turns.next()) out.push_back(ping_of(*turn));
  return out;
}

}  // namespace

TEST_CASE("a session waits for one message of each other session, however many they sent",
          "[server]") {
  MessageTurns turns;
  CHECK(turns.is_empty());
  CHECK_FALSE(turns.next());
  for (TimeUs i = 0; i < 4; ++i) turns.push(2, Ping{i}, 8);
  for (TimeUs i = 0; i < 3; ++i) turns.push(7, Ping{i}, 8);
  turns.push(5, Ping{0}, 8);
  CHECK(all_turns(turns) ==
        std::vector<SentPing>{{2, 0}, {5, 0}, {7, 0}, {2, 1}, {7, 1}, {2, 2}, {7, 2}, {2, 3}});
  CHECK(turns.is_empty());
}

TEST_CASE("a message that comes later waits for no second turn of another session", "[server]") {
  MessageTurns turns;
  for (TimeUs i = 0; i < 4; ++i) turns.push(2, Ping{i}, 8);
  REQUIRE(turns.next());
  turns.push(1, Ping{0}, 8);
  CHECK(all_turns(turns) == std::vector<SentPing>{{1, 0}, {2, 1}, {2, 2}, {2, 3}});
}

TEST_CASE("the messages of a session that ends are taken in their order", "[server]") {
  MessageTurns turns;
  for (TimeUs i = 0; i < 2; ++i) {
    turns.push(2, Ping{i}, 8);
    turns.push(3, Ping{i}, 16);
  }
  const auto first = turns.next_of(3), second = turns.next_of(3);
  REQUIRE((first && second));
  CHECK(ping_of(*first) == SentPing{3, 0});
  CHECK(first->bytes == 16);
  CHECK(ping_of(*second) == SentPing{3, 1});
  CHECK_FALSE(turns.next_of(3));
  CHECK(all_turns(turns) == std::vector<SentPing>{{2, 0}, {2, 1}});
}

TEST_CASE("players at another server take turns like those here, each in order",
          "[server][servers]") {
  MessageTurns turns;
  const auto relayed = [](SessionId player) {
    return Message(Relay{{player}, encode_message(Message(ChatRequest{"a line"}))});
  };
  RelayOpen first, second;
  first.session = 8;
  second.session = 9;
  // Session 2 is another server, 3 and 4 are players here.
  turns.push(2, first, 1);
  turns.push(2, second, 2);
  for (std::size_t i = 3; i < 6; ++i) turns.push(2, relayed(8), i);
  turns.push(2, relayed(9), 6);
  turns.push(2, RelayClose{9, 1, ""}, 7);
  turns.push(2, Ping{0}, 8);
  for (std::size_t i = 11; i < 13; ++i) turns.push(3, Ping{0}, i);
  turns.push(4, Ping{0}, 21);
  std::vector<std::size_t> order;
  for (int i = 0; i < 9; ++i) order.push_back(turns.next()->bytes);
  CHECK(order == std::vector<std::size_t>{8, 1, 2, 11, 21, 3, 6, 12, 4});
  // When the other server is gone, what is left of its players is taken, in order for each of them.
  CHECK(turns.next_of(2)->bytes == 5);
  CHECK(turns.next_of(2)->bytes == 7);
  CHECK_FALSE(turns.next_of(2));
  CHECK(turns.is_empty());
}
