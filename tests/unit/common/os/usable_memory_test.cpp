#include "common/os/usable_memory.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("the least limit of control groups counts, and \"max\" is none", "[os]") {
  CHECK_FALSE(memory_limit_of(""));
  CHECK_FALSE(memory_limit_of("max\nmax\n\n"));
  CHECK(memory_limit_of("max\n2147483648\nmax\n") == 2'147'483'648U);
  CHECK(memory_limit_of("4096\n1024\n8192\n") == 1024U);
  CHECK_FALSE(memory_limit_of("12 apples\n-1\n99999999999999999999999\n"));
}

TEST_CASE("this machine has some memory", "[os]") {
  const auto bytes = usable_memory_bytes();
  REQUIRE(bytes);
  CHECK(*bytes > std::uint64_t{16} << 20);
}
