// How the client prints chat, and reads what is typed.
#include "client/app/terminal_chat.hpp"

#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>

#include "protocol/limits.hpp"

namespace runstone {
namespace {

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

TEST_CASE("typed lines are read as they are complete, without waiting", "[client][chat]") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  const auto type = [&](const std::string& bytes) {
    REQUIRE(::write(ends[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  };
  using Lines = std::vector<std::string>;
  LineInput input(ends[0]);
  CHECK(input.take_lines().empty());
  type("hel");
  CHECK(input.take_lines().empty());
  type("lo\r\n\n/help\nrest");
  CHECK(input.take_lines() == Lines{"hello", "", "/help"});
  type(std::string(3'000, 'x'));
  CHECK(input.take_lines().empty());
  type("\n");
  const Lines cut = input.take_lines();
  REQUIRE(cut.size() == 1);
  CHECK(cut[0].size() == kCommandBytesMax);
  CHECK(cut[0].starts_with("restx"));
  type("no end");
  ::close(ends[1]);
  CHECK(input.take_lines().empty());
  CHECK(input.take_lines().empty());  // the end
  CHECK(input.take_lines().empty());
  ::close(ends[0]);
}

}  // namespace
}  // namespace runstone
