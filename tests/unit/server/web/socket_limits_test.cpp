#include "server/web/socket_limits.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr TimeUs kSecondUs = 1'000'000;

}  // namespace

TEST_CASE("an address has a number of sockets, and others do not notice", "[web]") {
  SocketLimits limits(3, 0);
  const AddressBlock one = address_block_v4(1), other = address_block_v4(2);
  for (int i = 0; i < 3; ++i) REQUIRE(limits.add(one, 0));
  CHECK_FALSE(limits.add(one, 0));
  CHECK(limits.add(other, 0));
  limits.remove(one);
  CHECK(limits.add(one, 0));
  for (int i = 0; i < 3; ++i) limits.remove(one);
  limits.remove(other);
  CHECK(limits.addresses() == 0);  // an address without sockets costs no memory
}

TEST_CASE("an address connects so often a second, ten times as often at once", "[web]") {
  SocketLimits limits(1'000, 2);
  const AddressBlock one = address_block_v4(1);
  TimeUs now_us = kSecondUs;
  for (int i = 0; i < 20; ++i) REQUIRE(limits.add(one, now_us));
  CHECK_FALSE(limits.add(one, now_us));
  now_us += kSecondUs;
  CHECK(limits.add(one, now_us));
  CHECK(limits.add(one, now_us));
  CHECK_FALSE(limits.add(one, now_us));
}
