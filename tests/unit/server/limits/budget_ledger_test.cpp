#include "server/limits/budget_ledger.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

constexpr AddressBlock kHome = address_block_v4(1), kSchool = address_block_v4(2);

constexpr Budget kUsual{10, 20};

Payer payer(std::uint8_t who, AddressBlock from, const Budget& budget = kUsual) {
  Payer out{{}, from, budget};
  out.key.fill(who);
  return out;
}

TEST_CASE("a key pays for its edits, from whatever address", "[server]") {
  BudgetLedger ledger(kUsual, 100);
  CHECK_FALSE(ledger.charge(payer(1, kHome), 15, 0));
  const auto refusal = ledger.charge(payer(1, kSchool), 15, 0);
  REQUIRE(refusal.has_value());
  CHECK(refusal->whose == std::string("key"));
  CHECK(refusal->wait_us == 1'000'000);
  CHECK_FALSE(ledger.charge(payer(2, kHome), 15, 0));  // another key is not concerned
  CHECK_FALSE(ledger.charge(payer(1, kSchool), 15, 1'000'000));
}

TEST_CASE("an address pays for all keys that come from it", "[server]") {
  BudgetLedger ledger(kUsual, 3);
  for (std::uint8_t who = 1; who <= 3; ++who) CHECK_FALSE(ledger.charge(payer(who, kHome), 20, 0));
  const auto refusal = ledger.charge(payer(4, kHome), 20, 0);
  REQUIRE(refusal.has_value());
  CHECK(refusal->whose == std::string("address"));
  CHECK(refusal->wait_us == 20 * 1'000'000 / 30 + 1);
  // The refused key paid nothing, so it can edit from elsewhere.
  CHECK_FALSE(ledger.charge(payer(4, kSchool), 20, 0));
}

TEST_CASE("an address pays in shares of the budget of each key", "[server]") {
  constexpr Budget kLarge{1'000, 2'000}, kSmall{1, 2};
  BudgetLedger ledger(kUsual, 2);                                 // an address has 40 units
  CHECK_FALSE(ledger.charge(payer(1, kHome, kLarge), 2'000, 0));  // 20 units of the address
  CHECK_FALSE(ledger.charge(payer(2, kHome, kSmall), 2, 0));      // 20 units
  const auto refusal = ledger.charge(payer(3, kHome), 1, 0);
  REQUIRE(refusal.has_value());
  CHECK(refusal->whose == std::string("address"));
  // A whole budget is never more than the address can ever pay.
  BudgetLedger one(kUsual, 1);
  CHECK_FALSE(one.charge(payer(1, kHome, {1, 1'000'000}), 1'000'000, 0));
}

TEST_CASE("a key whose budget changes begins with a full one", "[server]") {
  BudgetLedger ledger(kUsual, 0);
  CHECK_FALSE(ledger.charge(payer(1, kHome), 20, 0));
  CHECK(ledger.charge(payer(1, kHome), 1, 0));
  CHECK_FALSE(ledger.charge(payer(1, kHome, {10, 30}), 30, 0));
  CHECK(ledger.charge(payer(1, kHome, {10, 30}), 1, 0));
}

TEST_CASE("without limits nothing is refused, and nothing is kept", "[server]") {
  BudgetLedger ledger({}, 4);
  CHECK_FALSE(ledger.charge(payer(1, kHome, {}), 1'000'000, 0));
  CHECK(ledger.size() == 0);
  BudgetLedger keys_only(kUsual, 0);
  for (std::uint8_t who = 0; who < 200; ++who)
    CHECK_FALSE(keys_only.charge(payer(who, kHome), 20, 0));
}

TEST_CASE("budgets that have refilled are forgotten", "[server]") {
  BudgetLedger ledger(kUsual, 4);
  Payer fresh = payer(0, {});
  TimeUs now_us = 0;
  std::size_t largest = 0;
  for (std::uint64_t i = 0; i < 100'000; ++i) {  // a new key and address each millisecond
    fresh.key[0] = static_cast<std::uint8_t>(i);
    fresh.key[1] = static_cast<std::uint8_t>(i >> 8);
    fresh.key[2] = static_cast<std::uint8_t>(i >> 16);
    fresh.address = AddressBlock{i};
    CHECK_FALSE(ledger.charge(fresh, 1, now_us));
    now_us += 1'000;
    largest = std::max(largest, ledger.size());
  }
  CHECK(largest < 2'000);
}

TEST_CASE("work that was done already is owed by key and address, up to a full budget",
          "[server]") {
  BudgetLedger ledger(kUsual, 3);
  ledger.owe(payer(1, kHome), 1'000, 0);
  const auto refusal = ledger.charge(payer(1, kHome), 1, 0);
  REQUIRE(refusal.has_value());
  CHECK(refusal->wait_us == 2'100'000);  // 20 that are owed, and the one that is asked for
  CHECK(ledger.charge(payer(1, kSchool), 1, 2'000'000).has_value());
  CHECK(ledger.charge(payer(2, kHome), 1, 0).has_value());  // the address owes, too
  CHECK_FALSE(ledger.charge(payer(2, kSchool), 1, 0));
  CHECK_FALSE(ledger.charge(payer(1, kSchool), 1, 2'100'000));
}

TEST_CASE("huge budgets do not overflow", "[server]") {
  constexpr Budget kHuge{~0ULL, ~0ULL}, kNormal{100, 4'000};
  BudgetLedger ledger(kHuge, ~0ULL);
  CHECK_FALSE(ledger.charge(payer(1, kHome, kHuge), 1'000'000, 0));
  CHECK_FALSE(ledger.charge(payer(2, kHome, kNormal), 4'000, 0));
  BudgetLedger times(kNormal, ~0ULL);
  CHECK_FALSE(times.charge(payer(1, kHome, kNormal), 4'000, 0));
  CHECK_FALSE(times.charge(payer(2, kHome, kHuge), 1'000'000, 0));
}

}  // namespace
}  // namespace runstone
