#include "server/replay/camera_path.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace runstone {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

CameraPath read(const std::string& text, Sequence first = 0, Sequence last = 1000) {
  auto path = CameraPath::parse(text, "path.txt", first, last);
  INFO((path ? std::string() : path.error().message()));
  REQUIRE(path.has_value());
  return *std::move(path);
}

std::string refused(const std::string& text) {
  const auto path = CameraPath::parse(text, "path.txt", 0, 1000);
  REQUIRE_FALSE(path.has_value());
  return path.error().message();
}

}  // namespace

TEST_CASE("a camera moves in a straight line from station to station", "[server]") {
  const CameraPath path = read(
      "# a comment, and an empty line\n\n"
      "100 0 10 -20 0 0\r\n"
      "  200\t100 20 -20.5 90 -45  # above the gate\n"
      "400 100 20 -20.5 90 45\n");
  const DrawCamera start = path.at(100);
  CHECK(start.x == 0);
  CHECK(start.y == 10);
  CHECK(start.z == -20);
  const DrawCamera half = path.at(150);
  CHECK(half.x == Approx(50));
  CHECK(half.y == Approx(15));
  CHECK(half.z == Approx(-20.25));
  CHECK(half.yaw == Approx(45 * kDegree));
  CHECK(half.pitch == Approx(-22.5 * kDegree));
  CHECK(path.at(200).pitch == Approx(-45 * kDegree));
  CHECK(path.at(300).pitch == Approx(0).margin(1e-9));
  // The camera stands still before the first station and after the last.
  CHECK(path.at(0) == start);
  CHECK(path.at(400) == path.at(4000));
}

TEST_CASE("yaw turns the shorter way", "[server]") {
  CHECK(read("0 0 0 0 350 0\n100 0 0 0 10 0").at(50).yaw == Approx(360 * kDegree));
  CHECK(read("0 0 0 0 10 0\n100 0 0 0 350 0").at(50).yaw == Approx(0).margin(1e-9));
  CHECK(read("0 0 0 0 -170 0\n100 0 0 0 170 0").at(25).yaw == Approx(-175 * kDegree));
}

TEST_CASE("a percentage of the timelapse is a moment, also between two edits", "[server]") {
  const CameraPath path = read("0% 0 0 0 0 0\n50% 100 0 0 0 0\n1011 200 0 0 0 0", 1000, 1011);
  CHECK(path.at(1000).x == 0);
  CHECK(path.at(1005).x == Approx(100 * 5 / 5.5));
  CHECK(path.at(1006).x == Approx(100 + 100 * 0.5 / 5.5));
  CHECK(path.at(1011).x == 200);
}

TEST_CASE("the error of a camera path names the line and the reason", "[server]") {
  CHECK(refused("") == "path.txt: has no station");
  CHECK(refused("# nothing\n") == "path.txt: has no station");
  CHECK(refused("\nten 0 0 0 0 0").find("path.txt:2: the moment is no sequence number") == 0);
  for (const char* when : {"-1", "101%", "-1%", "nan%", "1.5", "%", "18446744073709551616"}) {
    CAPTURE(when);
    CHECK(refused(std::string(when) + " 0 0 0 0 0").find("path.txt:1: the moment") == 0);
  }
  CHECK(refused("1 0 0 0 0") == "path.txt:1: PITCH is missing: expected WHEN X Y Z YAW PITCH");
  CHECK(refused("1 0 0 0 0 91") == "path.txt:1: PITCH is no number from -90 to 90");
  CHECK(refused("1 0 0 0 nan 0") == "path.txt:1: YAW is no number from -360 to 360");
  CHECK(refused("1 0 1e30 0 0 0").find("path.txt:1: Y is no number") == 0);
  CHECK(refused("1 0 0x10 0 0 0").find("path.txt:1: Y is no number") == 0);
  CHECK(refused("1 0 0 0 0 0 0") == "path.txt:1: more than WHEN X Y Z YAW PITCH");
  CHECK(refused("1 0 0 0 0 0\n\n1 0 0 0 0 0") ==
        "path.txt:3: the moment is not after that of the station before");
  CHECK(refused("10 0 0 0 0 0\n0.5% 0 0 0 0 0").find("path.txt:2: the moment is not after") == 0);
  std::string many;
  for (std::size_t i = 0; i <= CameraPath::kStationsMax; ++i)
    many += std::to_string(i) + " 0 0 0 0 0\n";
  CHECK(refused(many) == "path.txt:10001: more than 10000 stations");
}

}  // namespace runstone
