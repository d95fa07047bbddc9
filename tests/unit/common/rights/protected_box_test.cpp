#include "common/rights/protected_box.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("the volume of a box is exact up to 2^64 - 1", "[rights]") {
  CHECK(volume_of({{0, 0, 0}, {1, 1, 1}}) == 1);
  CHECK(volume_of({{-1, -2, -3}, {1, 2, 3}}) == 48);
  CHECK(volume_of({{0, 0, 0}, {0, 5, 5}}) == 0);
  CHECK(volume_of({{0, 0, 0}, {5, 5, -1}}) == 0);
  CHECK(volume_of(columns(0, 0, 1, 1)) == 1ULL << 30);
  CHECK(volume_of(columns(-kWorldLimit, 0, kWorldLimit, 15)) == 15ULL << 60);
  CHECK(volume_of(columns(-kWorldLimit, 0, kWorldLimit, 16)) == UINT64_MAX);
  CHECK(volume_of(columns(-kWorldLimit, -kWorldLimit, kWorldLimit, kWorldLimit)) == UINT64_MAX);
}

}  // namespace runstone::test
