#include "server/limits/followed_position.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

TEST_CASE("a followed position moves towards the claimed one at most at its speed", "[limits]") {
  FollowedPosition position;
  position.start({0, 0, 0}, 1'000'000);
  CHECK(position.follow({300, 400, 0}, 10, 1'000'000) == WorldPos{0, 0, 0});
  CHECK(position.follow({300, 400, 0}, 10, 2'000'000) == WorldPos{6, 8, 0});
  CHECK(position.follow({6, 9, 0}, 10, 2'100'000) == WorldPos{6, 9, 0});  // a voxel in 0.1 s
  CHECK(position.follow({6, 9, 100}, 10, 11'000'000) == WorldPos{6, 9, 89});
}

TEST_CASE("jumping to and fro gains nothing", "[limits]") {
  FollowedPosition position;
  position.start({0, 0, 0}, 0);
  TimeUs now_us = 0;
  for (int i = 0; i < 100; ++i)
    position.follow({i % 2 == 0 ? 1000.0 : -1000.0, 0, 0}, 10, now_us += 10'000);
  CHECK(std::abs(position.follow({0, 0, 0}, 10, now_us).x) < 1);
}

TEST_CASE("without a speed limit the claimed position counts", "[limits]") {
  FollowedPosition position;
  position.start({0, 0, 0}, 0);
  CHECK(position.follow({1e6, 1, 2}, 0, 0) == WorldPos{1e6, 1, 2});
}

}  // namespace
}  // namespace runstone
