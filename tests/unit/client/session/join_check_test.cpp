#include "client/session/join_check.hpp"

#include <catch2/catch.hpp>

#include "protocol/limits.hpp"

namespace runstone::test {

TEST_CASE("a name that the encoder would reject is refused in words", "[client]") {
  CHECK(check_player_name("ada"));
  CHECK(check_player_name(std::string(kPlayerNameBytesMax, 'a')));
  CHECK(check_player_name("").error() == "a name has at least one character");
  // Ten characters of three bytes each fit, and eleven do not.
  std::string name;
  for (int i = 0; i < 10; ++i) name += "\xe7\x9f\xb3";
  CHECK(check_player_name(name));
  name += "\xe7\x9f\xb3";
  CHECK(check_player_name(name).error().find("at most 32 bytes, and this one has 33") !=
        std::string::npos);
  CHECK_FALSE(check_player_name(" ada"));
  CHECK_FALSE(check_player_name("a\"da"));
  CHECK_FALSE(
      check_player_name("a\xe2\x80\xae"
                        "da"));  // a character that changes the direction
  CHECK_FALSE(check_player_name("a\xff"));
}

TEST_CASE("an invite that the encoder would reject is refused in words", "[client]") {
  CHECK(check_ticket(""));
  CHECK(check_ticket(std::string(kTicketBytesMax, 'a')));
  CHECK_FALSE(check_ticket(std::string(kTicketBytesMax + 1, 'a')));
  CHECK_FALSE(check_ticket("a\n"));
}

}  // namespace runstone::test
