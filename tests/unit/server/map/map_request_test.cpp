#include "server/map/map_request.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace runstone;

namespace {

/// Returns the error of a request, "unknown path", or "" if it was understood.
std::string error_of(const std::string& path, const std::string& query = "") {
  const auto request = parse_map_request(path, query);
  if (request) return "";
  return request.error().is_unknown_path ? "unknown path" : request.error().what;
}

}  // namespace

TEST_CASE("requests of the map are parsed from path and query", "[map]") {
  const auto tile = parse_map_request("/map/tile/3/-12/7.png", "at=9120");
  REQUIRE(tile.has_value());
  const auto& picture = std::get<TilePictureRequest>(*tile);
  CHECK(picture.place == MapPlace{3, -12, 7});
  CHECK(picture.at == Sequence{9120});
  CHECK_FALSE(std::get<TilePictureRequest>(*parse_map_request("/map/tile/0/0/0.png", "")).at);
  CHECK(std::get<MapStateRequest>(*parse_map_request("/map/state.json", "since=7")).since ==
        Sequence{7});
  const auto builders = parse_map_request("/map/builders.json", "z=-4&x=3&at=0");
  REQUIRE(builders.has_value());
  CHECK(std::get<BuildersRequest>(*builders).x == 3);
  CHECK(std::get<BuildersRequest>(*builders).z == -4);
  CHECK(std::get<BuildersRequest>(*builders).at == Sequence{0});
  const auto moment = parse_map_request("/map/moment.json", "time_ms=1700000000000");
  REQUIRE(moment.has_value());
  CHECK(std::get<TimeUs>(std::get<MapMomentRequest>(*moment).of) == 1'700'000'000'000'000);
}

TEST_CASE("absurd tiles, times and places are refused with words", "[map]") {
  CHECK(error_of("/map/tile/9/0/0.png") == "zoom is a number from 0 to 8");
  CHECK(error_of("/map/tile/0/1048576/0.png") == "this tile lies outside of the world");
  CHECK(error_of("/map/tile/0/1048575/-1048576.png").empty());
  CHECK(error_of("/map/tile/8/4096/0.png") == "this tile lies outside of the world");
  CHECK(error_of("/map/tile/8/4095/-4096.png").empty());
  CHECK(error_of("/map/tile/0/2147483647/-2147483648.png") ==
        "this tile lies outside of the world");
  CHECK(error_of("/map/tile/0/0/0.png", "at=-1") == "at must be the number of an edit");
  CHECK(error_of("/map/tile/0/0/0.png", "at=9223372036854775807").empty());
  CHECK(error_of("/map/tile/0/0/0.png", "at=9223372036854775808") ==
        "at must be the number of an edit");
  CHECK(error_of("/map/builders.json", "x=536870912&z=0") ==
        "x and z must be a place in the world");
  CHECK(error_of("/map/builders.json", "x=536870911&z=-536870912").empty());
  CHECK(error_of("/map/moment.json", "time_ms=9223372036854775807") ==
        "time_ms must be milliseconds since 1970");
  CHECK(error_of("/map/moment.json", "time_ms=-1") == "time_ms must be milliseconds since 1970");
}

TEST_CASE("only one spelling of a request is understood", "[map]") {
  for (const char* path : {"/map/tile/0/0/0",
                           "/map/tile/0/0/0.png/",
                           "/map/tile/0/0/0.PNG",
                           "/map/tile/0/0.png",
                           "/map/tile/0/0/0/0.png",
                           "/map/tile//0/0.png",
                           "/map/tile/+0/0/0.png",
                           "/map/tile/00/0/0.png",
                           "/map/tile/0/-0/0.png",
                           "/map/tile/0/ 1/0.png",
                           "/map/tile/0/0x1/0.png",
                           "/map/tile/0/1e3/0.png",
                           "/map/tile/256/0/0.png",
                           "/map/tile/-1/0/0.png",
                           "/map/tile/0/99999999999/0.png",
                           "/map/tile/../../etc/passwd",
                           "/map/tile/0/0/../0.png",
                           "/map/tile/0/%30/0.png",
                           "/map/",
                           "/map/../world.sqlite",
                           "/map/world.sqlite",
                           "/map",
                           "",
                           "/map/tile/0/0/0.png.png",
                           "/map/state.json/",
                           "/map/tile/0/0/\n.png"}) {
    CAPTURE(path);
    CHECK(error_of(path) == "unknown path");
  }
  for (const char* query : {"at", "at=", "at=01", "at=+1", "at=1&at=1", "at=1&", "at=1&b=2", "AT=1",
                            "at=1%20", "at=1 ", "at==1", "&at=1", "at=0x10", "at=1;b"}) {
    CAPTURE(query);
    CHECK_FALSE(error_of("/map/tile/0/0/0.png", query).empty());
  }
  for (const char* query : {"", "x=1", "z=1", "x=1&z=", "x=1&z=2&y=3", "x=1&x=1&z=2"}) {
    CAPTURE(query);
    CHECK_FALSE(error_of("/map/builders.json", query).empty());
  }
  for (const char* query : {"", "seq=1&time_ms=1", "seq=", "time_ms=x"}) {
    CAPTURE(query);
    CHECK_FALSE(error_of("/map/moment.json", query).empty());
  }
}
