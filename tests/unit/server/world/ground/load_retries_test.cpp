#include "server/world/ground/load_retries.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr ChunkKey kFirst{};
constexpr ChunkKey kOther{0, {1, 0, 0}};
constexpr TimeUs kSecondUs = 1'000'000;

}  // namespace

TEST_CASE("the pause doubles with each failure, until the chunk is given up", "[world]") {
  LoadRetries retries;
  for (const TimeUs pause : {1, 2, 4, 8, 16, 32}) {
    CHECK(retries.failed(kFirst, 0) == pause * kSecondUs);
    CHECK(retries.take_due(pause * kSecondUs - 1).empty());
    CHECK(retries.take_due(pause * kSecondUs) == std::vector{kFirst});
    CHECK(retries.take_due(pause * kSecondUs).empty());  // it is under way
  }
  CHECK_FALSE(retries.failed(kFirst, 0));
  CHECK(retries.size() == 0);
}

TEST_CASE("each chunk has its own pause, which a load without failure ends", "[world]") {
  LoadRetries retries;
  REQUIRE(retries.failed(kFirst, 0));
  REQUIRE(retries.take_due(kSecondUs).size() == 1);
  REQUIRE(retries.failed(kFirst, kSecondUs) == 2 * kSecondUs);
  CHECK(retries.failed(kOther, kSecondUs) == kSecondUs);
  CHECK(retries.take_due(2 * kSecondUs) == std::vector{kOther});
  retries.ended(kOther);
  CHECK(retries.take_due(3 * kSecondUs) == std::vector{kFirst});
  retries.ended(kFirst);
  CHECK(retries.size() == 0);
  CHECK(retries.failed(kFirst, 0) == kSecondUs);
}

TEST_CASE("in a hurry every chunk is loaded once more at once", "[world]") {
  LoadRetries retries;
  REQUIRE(retries.failed(kFirst, 0));
  REQUIRE(retries.failed(kOther, 0));
  retries.hurry();
  CHECK(retries.take_due(1) == std::vector{kFirst, kOther});
  CHECK_FALSE(retries.failed(kFirst, 2));
  CHECK_FALSE(retries.failed(kOther, 2));
}
