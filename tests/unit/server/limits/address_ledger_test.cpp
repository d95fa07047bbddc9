#include "server/limits/address_ledger.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr TimeUs kSecond = 1'000'000;

constexpr AddressBlock v6(std::uint64_t network) { return AddressBlock{network}; }

}  // namespace

TEST_CASE("an address uses up its budget, and then pays as fast as it comes back", "[limits]") {
  AddressLedger ledger({2, 20});
  const AddressBlock one = address_block_v4(1), other = address_block_v4(2);
  for (int i = 0; i < 20; ++i) CHECK(ledger.take(one, 1, 0));
  CHECK_FALSE(ledger.take(one, 1, 0));
  CHECK(ledger.take(other, 20, 0));
  CHECK_FALSE(ledger.take(one, 1, kSecond / 2 - 1));
  CHECK(ledger.take(one, 1, kSecond / 2));
  CHECK_FALSE(ledger.take(one, 1, kSecond / 2));
}

TEST_CASE("the addresses of a range share a larger budget", "[limits]") {
  constexpr auto kShares = static_cast<std::uint32_t>(AddressLedger::kBudgetsPerRange);
  AddressLedger ledger({1, 3});
  for (std::uint32_t i = 0; i < kShares; ++i)
    CHECK(ledger.take(address_block_v4(0x0a000000 + i), 3, 0));
  CHECK_FALSE(ledger.take(address_block_v4(0x0a0000ff), 1, 0));
  CHECK(ledger.take(address_block_v4(0x0a000100), 3, 0));  // the next /24
  CHECK(ledger.take(address_block_v4(0x0a0000ff), 3, kSecond));
  for (std::uint32_t i = 0; i < kShares; ++i)
    CHECK(ledger.take(v6(0x2001'0db8'0001'0000 + i), 3, 0));
  CHECK_FALSE(ledger.take(v6(0x2001'0db8'0001'ffff), 1, 0));
  CHECK(ledger.take(v6(0x2001'0db8'0002'0000), 3, 0));  // the next /48
}

TEST_CASE("an address can be asked what it has, which takes nothing", "[limits]") {
  constexpr auto kShares = static_cast<std::uint32_t>(AddressLedger::kBudgetsPerRange);
  AddressLedger ledger({1, 3});
  const AddressBlock one = address_block_v4(0x0a000001), other = address_block_v4(0x0a0000ff);
  CHECK(ledger.has(one, 3, 0));
  CHECK_FALSE(ledger.has(one, 4, 0));
  CHECK(ledger.size() == 0);
  CHECK(ledger.take(one, 3, 0));
  CHECK_FALSE(ledger.has(one, 1, kSecond - 1));
  CHECK(ledger.has(one, 1, kSecond));
  for (std::uint32_t i = 1; i < kShares; ++i)
    CHECK(ledger.take(address_block_v4(0x0a000001 + i), 3, 0));
  CHECK_FALSE(ledger.has(other, 1, 0));  // its range has nothing left
  CHECK(ledger.has(address_block_v4(0x0a0001ff), 3, 0));
}

TEST_CASE("an address owes what it cannot pay, at most a whole budget", "[limits]") {
  AddressLedger ledger({2, 20});
  const AddressBlock one = address_block_v4(0x0a000001), other = address_block_v4(0x0a0000ff);
  ledger.charge(one, 15, 0);
  CHECK(ledger.has(one, 5, 0));
  CHECK_FALSE(ledger.has(one, 6, 0));
  ledger.charge(one, 15, 0);
  CHECK_FALSE(ledger.has(one, 1, 5 * kSecond));  // ten were owed
  CHECK(ledger.has(one, 2, 6 * kSecond));
  ledger.charge(one, 1'000'000, 6 * kSecond);
  CHECK_FALSE(ledger.has(one, 1, 16 * kSecond));
  CHECK(ledger.has(one, 1, 17 * kSecond));
  CHECK(ledger.take(other, 20, 7 * kSecond));  // the range owes nothing
}

TEST_CASE("without a limit nothing is refused or kept", "[limits]") {
  AddressLedger ledger({});
  CHECK(ledger.has(address_block_v4(1), 1'000, 0));
  for (int i = 0; i < 10'000; ++i) REQUIRE(ledger.take(address_block_v4(1), 1, 0));
  ledger.charge(address_block_v4(1), 1, 0);
  CHECK(ledger.size() == 0);
}

TEST_CASE("addresses that paid long ago are forgotten", "[limits]") {
  AddressLedger ledger({1, 10});
  for (std::uint32_t i = 0; i < 100'000; ++i)
    REQUIRE(ledger.take(address_block_v4(i * 256), 1, static_cast<TimeUs>(i) * kSecond / 100));
  // A budget is full again after a second, in which 100 addresses of as many ranges pay.
  CHECK(ledger.size() < 3'000);
}
