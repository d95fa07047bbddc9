// AddressBlock: the network address that shares a budget: an IPv4 address, or the /64 prefix of an
// IPv6 address, because a subscriber gets at least a /64 and can use every address in it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace runstone {

enum class AddressBlock : std::uint64_t {};

/// Returns the block of an IPv4 address.
constexpr AddressBlock address_block_v4(std::uint32_t address) {
  // ::ffff:0:0/96 holds the IPv4 addresses within IPv6, so no prefix of a /64 has this form: its
  // upper bits would be of the range 0000::/16, of which only ::1 is in use.
  return AddressBlock{0x0000'ffff'0000'0000ULL | address};
}
/// Returns the block of an IPv6 address, in network order. An IPv4 address within IPv6
/// (0:0:0:0:0:ffff:a.b.c.d) has the block of the IPv4 address.
constexpr AddressBlock address_block_v6(const std::array<unsigned char, 16>& address) {
  std::uint64_t high = 0, low = 0;
  for (std::size_t i = 0; i < 8; ++i) high = high << 8 | address[i];
  for (std::size_t i = 8; i < 16; ++i) low = low << 8 | address[i];
  if (high == 0 && low >> 32 == 0xffff) return address_block_v4(static_cast<std::uint32_t>(low));
  return AddressBlock{high};
}

/// Returns the first block of the range that one owner often has to itself: the /24 of an IPv4
/// address, the /48 of an IPv6 address.
constexpr AddressBlock address_range_of(AddressBlock block) {
  const auto bits = static_cast<std::uint64_t>(block);
  const bool is_v4 = bits >> 32 == 0xffff;
  return AddressBlock{is_v4 ? bits & ~std::uint64_t{0xff} : bits & ~std::uint64_t{0xffff}};
}

/// Returns the first block of the wide network of an address: the /16 of an IPv4 address, the /32 of
/// an IPv6 address. Most providers have at least one such network, and give ranges of it to customers.
constexpr AddressBlock wide_network_of(AddressBlock block) {
  const auto bits = static_cast<std::uint64_t>(block);
  const bool is_v4 = bits >> 32 == 0xffff;
  return AddressBlock{is_v4 ? bits & ~std::uint64_t{0xffff} : bits & ~std::uint64_t{0xffff'ffff}};
}

/// Returns true for the addresses of networks that nobody reaches from outside: 10.0.0.0/8,
/// 172.16.0.0/12, 192.168.0.0/16, fc00::/7 and fe80::/10.
constexpr bool is_of_local_network(AddressBlock block) {
  const auto bits = static_cast<std::uint64_t>(block);
  if (bits >> 32 == 0xffff) {
    const auto v4 = static_cast<std::uint32_t>(bits);
    return v4 >> 24 == 10 || v4 >> 20 == 0xac1 || v4 >> 16 == 0xc0a8;
  }
  return bits >> 57 == 0xfc >> 1 || bits >> 54 == 0xfe80 >> 6;
}

}  // namespace runstone
