#include "common/core/hex.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("bytes become two lower-case digits each, high half first", "[core]") {
  CHECK(to_hex(Bytes{}).empty());
  CHECK(to_hex(Bytes{0x00, 0x0f, 0xf0, 0xab, 0xff}) == "000ff0abff");
}
