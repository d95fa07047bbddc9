#include "server/web/server_status.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("the answer of the status socket gives counters and players", "[web]") {
  const auto read = parse_server_status(
      "|counters sessions=2 seq=9120 stack_depths=\"0:3 1:4\" rate=1.5 bytes_in=-1\n"
      "|player ana\n|player bea = 7\n|weather mild\n|version 1.2.3\n|read_only the disk is full\n"
      "=ok\n");
  REQUIRE(read.has_value());
  CHECK(read->is_up);
  CHECK(read->version == "1.2.3");
  CHECK(read->read_only == "the disk is full");
  CHECK(read->counter("sessions") == 2);
  CHECK(read->counter("seq") == 9120);
  CHECK(read->counter("bytes_in") == -1);
  CHECK(read->counters.count("rate") == 0);
  CHECK(read->counters.count("stack_depths") == 0);
  CHECK(read->counter("nothing of this name") == 0);
  CHECK(read->players == std::vector<std::string>{"ana", "bea = 7"});
}

TEST_CASE("the answer of the status socket tells where players are", "[web]") {
  const auto read = parse_server_status(
      "|player ana b\n|place 1.5 -20.0 3 ana b\n|place nan 1 2 x\n|place 1 2\n|place 1 2 3e x\n"
      "|place inf 1 2 x\n=ok\n");
  REQUIRE(read.has_value());
  REQUIRE(read->places.size() == 1);
  CHECK(read->places[0].name == "ana b");
  CHECK(read->places[0].y == -20);
}

TEST_CASE("the answer of the status socket tells the border of the world", "[web]") {
  const auto border = [](const std::string& line) {
    return parse_server_status("|border " + line + "\n=ok\n")->border;
  };
  REQUIRE(border("circle 1 -2 500").has_value());
  CHECK(border("circle 1 -2 500")->is_circle);
  CHECK(border("circle 1 -2 500")->numbers == std::array<std::int64_t, 4>{1, -2, 500, 0});
  REQUIRE(border("box 1 2 3 4").has_value());
  CHECK(border("box 1 2 3 4")->numbers == std::array<std::int64_t, 4>{1, 2, 3, 4});
  for (const char* line : {"", "box", "box 1 2 3", "box 1 2 3 4 5", "circle 1 2", "ring 1 2 3",
                           "circle 1 2 x", "box 1 2 3 99999999999999999999"})
    CHECK_FALSE(border(line).has_value());
  CHECK_FALSE(parse_server_status("=ok\n")->border.has_value());
}

TEST_CASE("an answer that is cut, refused or something else gives no status", "[web]") {
  const std::string whole = "|counters sessions=2\n|player ana\n=ok";
  for (std::size_t size = 0; size < whole.size(); ++size)
    CHECK_FALSE(parse_server_status(whole.substr(0, size)).has_value());
  CHECK(parse_server_status(whole).has_value());
  CHECK_FALSE(parse_server_status("|no such question\n=error\n").has_value());
  CHECK_FALSE(parse_server_status("HTTP/1.1 200 OK\n=ok\n").has_value());
}
