#include "server/limits/line_throttle.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

TEST_CASE("a line throttle passes ten lines a second and counts the others", "[server]") {
  LineThrottle throttle;
  for (int line = 0; line < 10; ++line) CHECK(throttle.take(0) == 0U);
  for (int line = 0; line < 3; ++line) CHECK_FALSE(throttle.take(0).has_value());
  CHECK(throttle.take(100'000) == 3U);
  CHECK_FALSE(throttle.take(100'000).has_value());
  CHECK(throttle.take(10'000'000) == 1U);
  CHECK(throttle.take(10'000'000) == 0U);
}

}  // namespace
}  // namespace runstone
