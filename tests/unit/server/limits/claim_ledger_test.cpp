#include "server/limits/claim_ledger.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("an address claims so many names within an hour", "[limits][names]") {
  ClaimLedger ledger(4);
  const AddressBlock here = address_block_v4(1), there = address_block_v4(2);
  for (int i = 0; i < 4; ++i) CHECK(ledger.take(here, 0));
  CHECK_FALSE(ledger.take(here, 0));
  CHECK(ledger.take(there, 0));
  constexpr TimeUs kQuarter = 900'000'000;
  CHECK_FALSE(ledger.take(here, kQuarter - 1));
  CHECK(ledger.take(here, kQuarter));
  CHECK_FALSE(ledger.take(here, kQuarter));
  ClaimLedger unlimited(0);
  for (int i = 0; i < 10'000; ++i) CHECK(unlimited.take(here, 0));
}
