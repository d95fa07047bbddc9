#include "server/limits/connection_ledger.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr TimeUs kSecond = 1'000'000;

}  // namespace

TEST_CASE("an address may connect ten times its rate at once, and then at its rate", "[limits]") {
  ConnectionLedger ledger(2);
  const AddressBlock one = address_block_v4(1), other = address_block_v4(2);
  for (int i = 0; i < 20; ++i) CHECK(ledger.take(one, 0));
  CHECK_FALSE(ledger.take(one, 0));
  CHECK(ledger.take(other, 0));
  CHECK_FALSE(ledger.take(one, kSecond / 2 - 1));
  CHECK(ledger.take(one, kSecond / 2));
  CHECK_FALSE(ledger.take(one, kSecond / 2));
}

TEST_CASE("without a limit an address connects as often as it likes", "[limits]") {
  ConnectionLedger ledger(0);
  for (int i = 0; i < 10'000; ++i) REQUIRE(ledger.take(address_block_v4(1), 0));
  CHECK(ledger.size() == 0);
}

TEST_CASE("addresses that connected long ago are forgotten", "[limits]") {
  ConnectionLedger ledger(1);
  for (std::uint32_t i = 0; i < 100'000; ++i)
    REQUIRE(ledger.take(address_block_v4(i), static_cast<TimeUs>(i) * kSecond / 100));
  // A budget is full again after a second, in which 100 addresses connect.
  CHECK(ledger.size() < 3'000);
}
