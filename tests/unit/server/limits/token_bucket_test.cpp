#include "server/limits/token_bucket.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

TEST_CASE("a token bucket allows its burst, then its rate", "[world]") {
  TokenBucket bucket(10, 5);
  for (int i = 0; i < 5; ++i) CHECK(bucket.take(1, 0));
  CHECK_FALSE(bucket.take(1, 0));
  CHECK_FALSE(bucket.take(1, 99'999));
  CHECK(bucket.take(1, 100'000));
  CHECK_FALSE(bucket.take(2, 250'000));
  CHECK(bucket.take(1, 250'000));
  CHECK(bucket.take(5, 10'000'000'000'000));  // never more than the burst, after any pause
  CHECK_FALSE(bucket.take(1, 10'000'000'000'000));
}

TEST_CASE("a clock that goes back adds no tokens, and a rate of 0 is no limit", "[world]") {
  TokenBucket bucket(1, 1);
  CHECK(bucket.take(1, 5'000'000));
  CHECK_FALSE(bucket.take(1, 1'000'000));
  CHECK_FALSE(bucket.take(1, 5'500'000));
  CHECK(bucket.take(1, 6'000'000));
  TokenBucket free(0, 0);
  CHECK(free.take(1'000'000, 0));
}

}  // namespace
}  // namespace runstone
