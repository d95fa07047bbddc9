#include "client/play/printed_line.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("only a line of a player begins with a name", "[client][chat]") {
  CHECK(printed_line({ChatLineKind::player, 7, "ana", "hi <all>", 0}) == "<ana> hi <all>");
  CHECK(printed_line({ChatLineKind::player, 7, "ana> hi <bea", "x", 0}) == "<ana) hi (bea> x");
  CHECK(printed_line({ChatLineKind::server, 0, "", "restart", 0}) == "[server] restart");
  CHECK(printed_line({ChatLineKind::message_of_the_day, 0, "", "hello", 0}) == "[today] hello");
  CHECK(printed_line({ChatLineKind::refused, 0, "", "you are muted", 0}) ==
        "[not sent] you are muted");
  CHECK(printed_line({static_cast<ChatLineKind>(9), 0, "", "news", 0}) == "[chat] news");
  CHECK(printed_line({ChatLineKind::player, 7, "ana",
                      "a\xe2\x80\xae"
                      "b",
                      0}) == "<ana> a?b");
}

}  // namespace runstone::test
