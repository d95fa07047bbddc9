#include "common/core/token_bucket.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

TEST_CASE("a token bucket allows its burst, then its rate", "[core]") {
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

TEST_CASE("a clock that goes back adds no tokens, and a rate of 0 is no limit", "[core]") {
  TokenBucket bucket(1, 1);
  CHECK(bucket.take(1, 5'000'000));
  CHECK_FALSE(bucket.take(1, 1'000'000));
  CHECK_FALSE(bucket.take(1, 5'500'000));
  CHECK(bucket.take(1, 6'000'000));
  TokenBucket free(0, 0);
  CHECK(free.take(1'000'000, 0));
}

TEST_CASE("a token bucket says how long the tokens take", "[core]") {
  TokenBucket bucket(10, 5);
  CHECK(bucket.wait_us(5, 0) == 0);
  CHECK(bucket.wait_us(6, 0) == TokenBucket::kNever);
  CHECK(bucket.take(5, 0));
  CHECK_FALSE(bucket.is_full(0));
  CHECK(bucket.wait_us(1, 0) == 100'000);
  CHECK(bucket.wait_us(5, 50'000) == 450'000);
  CHECK(bucket.take(5, 500'000));
  CHECK(bucket.is_full(1'000'000));
  bucket.drain(1'000'000);
  CHECK(bucket.wait_us(1, 1'000'000) == 100'000);
  TokenBucket slow(3, 1);
  CHECK(slow.take(1, 0));
  const TimeUs wait_us = slow.wait_us(1, 0);
  CHECK_FALSE(slow.take(1, wait_us - 1));
  CHECK(slow.take(1, wait_us));
}

TEST_CASE("a token bucket of huge numbers does not overflow", "[core]") {
  TokenBucket bucket(~0ULL, ~0ULL);
  CHECK(bucket.take(TokenBucket::kBurstMax, 0));
  CHECK_FALSE(bucket.take(1, 0));
  CHECK(bucket.take(1, 1));
  CHECK(bucket.wait_us(~0ULL, 1) == TokenBucket::kNever);
  CHECK(bucket.is_full(10'000'000'000'000));
}

TEST_CASE("a slow bucket fills over many hours", "[core]") {
  TokenBucket bucket(1, 100'000);
  REQUIRE(bucket.take(100'000, 0));
  const TimeUs later_us = TimeUs{36'000} * 1'000'000;
  CHECK_FALSE(bucket.take(36'001, later_us));
  CHECK(bucket.take(36'000, later_us));
  CHECK(bucket.wait_us(100'001, later_us) == TokenBucket::kNever);
  CHECK(bucket.take(100'000, std::numeric_limits<TimeUs>::max()));
}

TEST_CASE("a token bucket owes what it cannot pay, at most what it holds", "[core]") {
  constexpr TimeUs kSecond = 1'000'000;
  TokenBucket bucket(10, 20);
  bucket.charge(25, 0);
  CHECK_FALSE(bucket.take(1, kSecond / 2));  // the first five tokens pay the rest
  CHECK(bucket.take(1, kSecond / 2 + kSecond / 10));
  CHECK(bucket.wait_us(3, kSecond / 2 + kSecond / 10) == 3 * kSecond / 10);
  bucket.charge(1'000, kSecond);
  CHECK(bucket.wait_us(1, kSecond) == 2 * kSecond + kSecond / 10);
  CHECK_FALSE(bucket.is_full(4 * kSecond));
  CHECK(bucket.is_full(5 * kSecond));
  CHECK(bucket.take(20, 5 * kSecond));
}

}  // namespace
}  // namespace runstone
