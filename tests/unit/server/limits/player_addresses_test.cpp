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

}  // namespace

TEST_CASE("players who came from one address are found together", "[limits]") {
  PlayerAddresses addresses;
  const AddressBlock home = address_block_v4(1), work = address_block_v4(2);
  addresses.note(numbered_key(1), home);
  addresses.note(numbered_key(2), home);
  addresses.note(numbered_key(2), work);
  addresses.note(numbered_key(3), work);
  addresses.note(numbered_key(4), address_block_v4(3));
  using Keys = std::vector<PublicKey>;
  CHECK(addresses.sharing(numbered_key(1)) == Keys{numbered_key(1), numbered_key(2)});
  CHECK(addresses.sharing(numbered_key(2)) ==
        Keys{numbered_key(1), numbered_key(2), numbered_key(3)});
  CHECK(addresses.sharing(numbered_key(4)) == Keys{numbered_key(4)});
  CHECK(addresses.sharing(numbered_key(5)).empty());
}

TEST_CASE("sessions without an address share nothing", "[limits]") {
  PlayerAddresses addresses;
  addresses.note(numbered_key(1), AddressBlock{});
  addresses.note(numbered_key(2), AddressBlock{});
  CHECK(addresses.sharing(numbered_key(1)).empty());
  CHECK(addresses.size() == 0);
}

TEST_CASE("many addresses and many keys of one address take bounded memory", "[limits]") {
  PlayerAddresses addresses;
  const auto limit = static_cast<std::uint32_t>(PlayerAddresses::kAddressesMax);
  for (std::uint32_t i = 1; i <= 2 * limit; ++i) {
    addresses.note(numbered_key(i), address_block_v4(i));
    addresses.note(numbered_key(1), address_block_v4(1));  // used again and again, so it stays
  }
  CHECK(addresses.size() == limit);
  CHECK(addresses.sharing(numbered_key(1)).size() == 1);
  CHECK(addresses.sharing(numbered_key(2)).empty());
  CHECK(addresses.sharing(numbered_key(2 * limit)).size() == 1);
  const auto keys = static_cast<std::uint32_t>(PlayerAddresses::kKeysOfAddressMax);
  for (std::uint32_t i = 0; i < 3 * keys; ++i)
    addresses.note(numbered_key(i + 10), address_block_v4(9));
  CHECK(addresses.sharing(numbered_key(3 * keys + 9)).size() == keys);
}

}  // namespace runstone::test
