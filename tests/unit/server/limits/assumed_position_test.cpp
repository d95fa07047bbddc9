#include "server/limits/assumed_position.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

TEST_CASE("an assumed position moves towards the claimed one at most at its speed", "[limits]") {
  AssumedPosition position;
  position.start({0, 0, 0}, 1'000'000);
  CHECK(position.advance({300, 400, 0}, 10, 1'000'000) == WorldPos{0, 0, 0});
  CHECK(position.advance({300, 400, 0}, 10, 2'000'000) == WorldPos{6, 8, 0});
  CHECK(position.advance({6, 9, 0}, 10, 2'100'000) == WorldPos{6, 9, 0});  // a voxel in 0.1 s
  CHECK(position.advance({6, 9, 100}, 10, 11'000'000) == WorldPos{6, 9, 89});
}

TEST_CASE("jumping to and fro gains nothing", "[limits]") {
  AssumedPosition position;
  position.start({0, 0, 0}, 0);
  TimeUs now_us = 0;
  for (int i = 0; i < 100; ++i)
    position.advance({i % 2 == 0 ? 1000.0 : -1000.0, 0, 0}, 10, now_us += 10'000);
  CHECK(std::abs(position.advance({0, 0, 0}, 10, now_us).x) < 1);
}

TEST_CASE("without a speed limit the claimed position counts", "[limits]") {
  AssumedPosition position;
  position.start({0, 0, 0}, 0);
  CHECK(position.advance({1e6, 1, 2}, 0, 0) == WorldPos{1e6, 1, 2});
}

}  // namespace
}  // namespace runstone
