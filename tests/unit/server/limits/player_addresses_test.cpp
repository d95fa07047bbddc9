#include "server/limits/player_addresses.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

PublicKey numbered_key(std::uint32_t number) {
  PublicKey key{};
  key[0] = static_cast<std::uint8_t>(number >> 16);
  key[1] = static_cast<std::uint8_t>(number >> 8);
  key[2] = static_cast<std::uint8_t>(number);
  return key;
}

bool has_none(const PublicKey&) { return false; }

/// Returns the block of the /64 with this number in an IPv6 /48.
AddressBlock subnet(std::uint64_t site, std::uint64_t number) {
  return AddressBlock{0x2001'0db8'0000'0000ULL | site << 16 | number};
}

}  // namespace

TEST_CASE("players who came from one address are found together", "[limits]") {
  PlayerAddresses addresses;
  const AddressBlock home = address_block_v4(1), work = address_block_v4(2);
  addresses.note(numbered_key(1), home, has_none);
  addresses.note(numbered_key(2), home, has_none);
  addresses.note(numbered_key(2), work, has_none);
  addresses.note(numbered_key(3), work, has_none);
  addresses.note(numbered_key(4), address_block_v4(3), has_none);
  using Keys = std::vector<PublicKey>;
  CHECK(addresses.sharing(numbered_key(1)) == Keys{numbered_key(1), numbered_key(2)});
  CHECK(addresses.sharing(numbered_key(2)) ==
        Keys{numbered_key(1), numbered_key(2), numbered_key(3)});
  CHECK(addresses.sharing(numbered_key(4)) == Keys{numbered_key(4)});
  CHECK(addresses.sharing(numbered_key(5)).empty());
}

TEST_CASE("sessions without an address, and those of the host itself, share nothing", "[limits]") {
  PlayerAddresses addresses;
  addresses.note(numbered_key(1), address_block_v4(0x7f00'0001), has_none);
  addresses.note(numbered_key(2), address_block_v4(0x7f00'0001), has_none);
  addresses.note(numbered_key(1), AddressBlock{}, has_none);
  addresses.note(numbered_key(2), AddressBlock{}, has_none);
  CHECK(addresses.sharing(numbered_key(1)).empty());
  CHECK(addresses.size() == 0);
}

TEST_CASE("many addresses and many keys of one address take bounded memory", "[limits]") {
  PlayerAddresses addresses;
  const auto limit = static_cast<std::uint32_t>(PlayerAddresses::kAddressesMax);
  for (std::uint32_t i = 1; i <= 2 * limit; ++i) {
    addresses.note(numbered_key(i), address_block_v4(i), has_none);
    addresses.note(numbered_key(1), address_block_v4(1),
                   has_none);  // used again and again, so it stays
  }
  CHECK(addresses.size() == limit);
  CHECK(addresses.sharing(numbered_key(1)).size() == 1);
  CHECK(addresses.sharing(numbered_key(2)).empty());
  CHECK(addresses.sharing(numbered_key(2 * limit)).size() == 1);
  const auto keys = static_cast<std::uint32_t>(PlayerAddresses::kKeysOfAddressMax);
  for (std::uint32_t i = 0; i < 3 * keys; ++i)
    addresses.note(numbered_key(i + 10), address_block_v4(9), has_none);
  CHECK(addresses.sharing(numbered_key(3 * keys + 9)).size() == keys);
}

TEST_CASE("keys that build nothing do not displace a player who has built", "[limits]") {
  PlayerAddresses addresses;
  const auto built = [](const PublicKey& key) { return key == numbered_key(1); };
  const AddressBlock home = address_block_v4(9);
  addresses.note(numbered_key(1), home, built);
  for (std::uint32_t i = 2; i < 1'000; ++i) addresses.note(numbered_key(i), home, built);
  CHECK(addresses.sharing(numbered_key(1)).size() == PlayerAddresses::kKeysOfAddressMax);
  CHECK(addresses.sharing(numbered_key(999)).front() == numbered_key(1));
  const auto limit = static_cast<std::uint32_t>(PlayerAddresses::kAddressesMax);
  for (std::uint32_t i = 0; i < 2 * limit; ++i)
    addresses.note(numbered_key(2'000 + i), address_block_v4(100 + i), built);
  CHECK(addresses.size() == limit);
  CHECK_FALSE(addresses.sharing(numbered_key(1)).empty());
}

TEST_CASE("the addresses of one IPv6 /48 displace each other, and nobody else", "[limits]") {
  PlayerAddresses addresses;
  const auto built = [](const PublicKey& key) { return key == numbered_key(1); };
  addresses.note(numbered_key(1), subnet(7, 0), built);
  addresses.note(numbered_key(2), subnet(8, 0), built);
  for (std::uint32_t i = 1; i < 10'000; ++i)
    addresses.note(numbered_key(10 + i), subnet(7, i), built);
  CHECK(addresses.size() == PlayerAddresses::kAddressesOfRangeMax + 1);
  CHECK_FALSE(addresses.sharing(numbered_key(1)).empty());
  CHECK_FALSE(addresses.sharing(numbered_key(2)).empty());
  CHECK(addresses.sharing(numbered_key(11)).empty());
  CHECK_FALSE(addresses.sharing(numbered_key(10 + 9'999)).empty());
}

}  // namespace runstone::test
