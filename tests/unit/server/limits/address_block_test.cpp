#include "common/core/address_block.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

using Address = std::array<unsigned char, 16>;

TEST_CASE("an IPv4 address is a block, also within IPv6", "[server]") {
  const AddressBlock mapped =
      address_block_v6(Address{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 192, 0, 2, 7});
  CHECK(mapped == address_block_v4(0xc000'0207));
  CHECK(mapped != address_block_v4(0xc000'0208));
}

TEST_CASE("the 64 upper bits of an IPv6 address are its block", "[server]") {
  Address one{0x20, 0x01, 0x0d, 0xb8, 0, 0, 0, 1};
  Address other = one;
  other[15] = 99;
  CHECK(address_block_v6(one) == address_block_v6(other));
  other[7] = 2;
  CHECK(address_block_v6(one) != address_block_v6(other));
  Address loopback{};
  loopback[15] = 1;
  CHECK(address_block_v6(loopback) != address_block_v4(1));
  CHECK(address_block_v6(loopback) != address_block_v4(0));
}

TEST_CASE("an address lies in a range and in a wide network", "[server]") {
  const auto v4 = address_block_v4(0xc633'6407);
  CHECK(address_range_of(v4) == address_block_v4(0xc633'6400));
  CHECK(wide_network_of(v4) == address_block_v4(0xc633'0000));
  const AddressBlock v6 = address_block_v6(Address{0x20, 0x01, 0x0d, 0xb8, 1, 2, 3, 4, 5});
  CHECK(address_range_of(v6) == address_block_v6(Address{0x20, 0x01, 0x0d, 0xb8, 1, 2}));
  CHECK(wide_network_of(v6) == address_block_v6(Address{0x20, 0x01, 0x0d, 0xb8}));
}

}  // namespace
}  // namespace runstone
