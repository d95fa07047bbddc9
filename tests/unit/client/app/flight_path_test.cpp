#include "client/app/flight_path.hpp"

#include <catch2/catch.hpp>
#include <numbers>

using namespace runstone;

TEST_CASE("a camera path moves and turns evenly between its places", "[client_app]") {
  const auto path = FlightPath::parse(
      "# start\n0 10 0 0 0 0\n\n10 10 0 90 -45 10  # along x\n"
      "10 10 20 90 -45 5\n",
      "p");
  REQUIRE(path.has_value());
  CHECK(path->frames() == 15);
  CHECK(path->place(0).at.x == Approx(0));
  CHECK(path->place(5).at.x == Approx(5));
  CHECK(path->place(5).yaw == Approx(std::numbers::pi / 4));
  CHECK(path->place(5).pitch == Approx(-std::numbers::pi / 8));
  CHECK(path->place(10).at.x == Approx(10));
  CHECK(path->place(10).at.z == Approx(0));
  CHECK(path->place(14).at.z == Approx(16));
}

TEST_CASE("a wrong camera path is refused with its line", "[client_app]") {
  const auto line_of = [](const char* text) {
    const auto path = FlightPath::parse(text, "p");
    REQUIRE_FALSE(path.has_value());
    return path.error().line;
  };
  CHECK(line_of("0 0 0 0 0 0\n1 2 3\n") == 2);
  CHECK(line_of("0 0 0 0 0 x\n") == 1);
  CHECK(line_of("0 0 0 0 0 0 7\n") == 1);
  CHECK(line_of("0 0 0 0 0 0\n0 0 0 0 0 -1\n") == 2);
  CHECK(line_of("0 0 0 0 0 0\n0 0 0 0 0 1e9\n") == 2);
  CHECK(line_of("") == 0);
  CHECK(line_of("0 0 0 0 0 0\n1 1 1 0 0 0\n") == 2);  // no frame between them
}
