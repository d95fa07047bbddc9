#include "common/core/hex.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("bytes become two lower-case digits each, high half first", "[core]") {
  CHECK(to_hex(Bytes{}).empty());
  CHECK(to_hex(Bytes{0x00, 0x0f, 0xf0, 0xab, 0xff}) == "000ff0abff");
}

TEST_CASE("digits of either case become bytes, and nothing else does", "[core]") {
  Bytes out(2);
  REQUIRE(read_hex("0aFf", out));
  CHECK(out == Bytes{0x0a, 0xff});
  for (const char* wrong : {"", "0aF", "0aFf0", "0aFg", "0a-1", "+aff", " aff", "0x0a"})
    CHECK_FALSE(read_hex(wrong, out));
  CHECK(read_hex("", {}));
}
