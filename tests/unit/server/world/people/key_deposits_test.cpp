#include "server/world/people/key_deposits.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

KeySlot numbered_slot(std::size_t number) {
  KeySlot slot{};
  slot[0] = static_cast<std::uint8_t>(number);
  slot[1] = static_cast<std::uint8_t>(number >> 8);
  return slot;
}

PublicKey numbered_key(std::size_t number) {
  PublicKey key{};
  key[0] = static_cast<std::uint8_t>(number);
  key[1] = static_cast<std::uint8_t>(number >> 8);
  return key;
}

KeyDeposit numbered_deposit(std::size_t number) {
  return {numbered_slot(number), Bytes(1, static_cast<std::uint8_t>(number)), {}};
}

constexpr AddressBlock kDepositor = address_block_v4(0x0a000001);

AddressBlock numbered_address(std::size_t number) {
  return address_block_v4(static_cast<std::uint32_t>(number));
}

}  // namespace

TEST_CASE("a deposited key can be taken once", "[world]") {
  KeyDeposits deposits;
  CHECK(deposits.put(numbered_key(1), kDepositor, numbered_deposit(1), 0).has_value());
  CHECK_FALSE(deposits.take(numbered_slot(2), 0).has_value());
  CHECK(deposits.take(numbered_slot(1), 0) == Bytes{1});
  CHECK_FALSE(deposits.take(numbered_slot(1), 0).has_value());
  CHECK(deposits.size() == 0);
}

TEST_CASE("a deposit ends", "[world]") {
  KeyDeposits deposits;
  REQUIRE(deposits.put(numbered_key(1), kDepositor, numbered_deposit(1), 5).has_value());
  REQUIRE(deposits.put(numbered_key(2), kDepositor, numbered_deposit(2), 5).has_value());
  CHECK(deposits.take(numbered_slot(1), 5 + kDepositUs - 1).has_value());
  CHECK_FALSE(deposits.take(numbered_slot(2), 5 + kDepositUs).has_value());
  REQUIRE(deposits.put(numbered_key(3), kDepositor, numbered_deposit(3), 5).has_value());
  REQUIRE(
      deposits.put(numbered_key(4), kDepositor, numbered_deposit(4), 5 + kDepositUs).has_value());
  CHECK(deposits.size() == 1);
}

TEST_CASE("a new deposit of a key replaces the old one", "[world]") {
  KeyDeposits deposits;
  REQUIRE(deposits.put(numbered_key(1), kDepositor, numbered_deposit(1), 0).has_value());
  CHECK(deposits.put(numbered_key(1), kDepositor, numbered_deposit(2), 0).has_value());
  CHECK_FALSE(deposits.take(numbered_slot(1), 0).has_value());
  CHECK(deposits.take(numbered_slot(2), 0).has_value());
}

TEST_CASE("nobody takes the slot of somebody else", "[world]") {
  KeyDeposits deposits;
  REQUIRE(deposits.put(numbered_key(1), kDepositor, numbered_deposit(1), 0).has_value());
  KeyDeposit forged = numbered_deposit(1);
  forged.sealed = {9};
  CHECK_FALSE(deposits.put(numbered_key(2), kDepositor, forged, 0).has_value());
  CHECK(deposits.take(numbered_slot(1), 0) == Bytes{1});
}

TEST_CASE("deposits are bounded for an address and in all", "[world]") {
  KeyDeposits deposits;
  for (std::size_t i = 0; i < kDepositsPerAddress; ++i)
    REQUIRE(deposits.put(numbered_key(i), kDepositor, numbered_deposit(i), 0).has_value());
  CHECK_FALSE(
      deposits.put(numbered_key(9'000), kDepositor, numbered_deposit(9'000), 0).has_value());
  CHECK(deposits.put(numbered_key(0), kDepositor, numbered_deposit(0), 0)
            .has_value());  // it replaces its own
  for (std::size_t i = kDepositsPerAddress; i < kDepositsMax; ++i)
    REQUIRE(deposits.put(numbered_key(i), numbered_address(i), numbered_deposit(i), 0).has_value());
  CHECK_FALSE(deposits.put(numbered_key(9'000), numbered_address(9'000), numbered_deposit(9'000), 0)
                  .has_value());
  CHECK(deposits.size() == kDepositsMax);
  CHECK(deposits
            .put(numbered_key(9'000), numbered_address(9'000), numbered_deposit(9'000), kDepositUs)
            .has_value());
}

}  // namespace runstone::test
