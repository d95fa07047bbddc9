#include "server/world/order/players.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace runstone;

namespace {

PublicKey player_key(std::uint8_t first) { return PublicKey{first}; }

}  // namespace

TEST_CASE("a player who leaves without an edit is a visitor until the key comes back",
          "[server][players]") {
  Players players;
  const AuthorId ana = players.enter(player_key(1), "ana");
  const AuthorId ben = players.enter(player_key(2), "ben");
  REQUIRE(players.take_unsaved(ben).has_value());
  CHECK_FALSE(players.forget_unsaved(ben));  // the store has ben
  REQUIRE(players.forget_unsaved(ana));
  REQUIRE(players.visitors().size() == 1);
  CHECK(players.visitors()[0].author == ana);
  CHECK(players.visitors()[0].name == "ana");
  CHECK(players.visitors()[0].key == player_key(1));

  const AuthorId again = players.enter(player_key(1), "anna");
  CHECK(again > ben);
  CHECK(players.visitors().empty());
}

TEST_CASE("a number whose row is lost is not given again", "[server][players]") {
  Players players;
  players.restore({2, player_key(2), "ben"});
  players.begin_above(5);
  CHECK(players.enter(player_key(2), "ben") == 2);
  CHECK(players.enter(player_key(1), "ana") == 6);
  players.begin_above(1);
  CHECK(players.enter(player_key(3), "cid") == 7);
}

TEST_CASE("the number of remembered visitors is bounded", "[server][players]") {
  Players players;
  for (std::size_t i = 0; i <= Players::kVisitorsMax; ++i) {
    PublicKey key{};
    key[0] = static_cast<std::uint8_t>(i);
    key[1] = 1;
    REQUIRE(players.forget_unsaved(players.enter(key, std::to_string(i))));
  }
  CHECK(players.visitors().size() == Players::kVisitorsMax);
  CHECK(players.visitors().front().name == "1");
}
