#include "server/limits/edit_ledger.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

constexpr AddressBlock kHome = address_block_v4(1), kSchool = address_block_v4(2);

EditPayer payer(std::uint8_t who, AddressBlock from) {
  EditPayer out;
  out.key.fill(who);
  out.address = from;
  return out;
}

TEST_CASE("a key pays for its edits, from whatever address", "[server]") {
  EditLedger ledger({10, 20}, 100);
  CHECK_FALSE(ledger.charge(payer(1, kHome), 15, 0));
  const auto refusal = ledger.charge(payer(1, kSchool), 15, 0);
  REQUIRE(refusal.has_value());
  CHECK(refusal->whose == std::string("key"));
  CHECK(refusal->wait_us == 1'000'000);
  CHECK(refusal->text() == "the edit budget of your key is used up: again in 1.0 s");
  CHECK_FALSE(ledger.charge(payer(2, kHome), 15, 0));  // another key is not concerned
  CHECK_FALSE(ledger.charge(payer(1, kSchool), 15, 1'000'000));
}

TEST_CASE("an address pays for all keys that come from it", "[server]") {
  EditLedger ledger({10, 20}, 3);
  for (std::uint8_t who = 1; who <= 3; ++who) CHECK_FALSE(ledger.charge(payer(who, kHome), 20, 0));
  const auto refusal = ledger.charge(payer(4, kHome), 20, 0);
  REQUIRE(refusal.has_value());
  CHECK(refusal->whose == std::string("address"));
  CHECK(refusal->wait_us == 20 * 1'000'000 / 30 + 1);
  // The refused key paid nothing, so it can edit from elsewhere.
  CHECK_FALSE(ledger.charge(payer(4, kSchool), 20, 0));
}

TEST_CASE("without limits nothing is refused, and nothing is kept", "[server]") {
  EditLedger ledger({0, 0}, 4);
  CHECK_FALSE(ledger.charge(payer(1, kHome), 1'000'000, 0));
  CHECK(ledger.size() == 0);
  EditLedger keys_only({10, 20}, 0);
  for (std::uint8_t who = 0; who < 200; ++who)
    CHECK_FALSE(keys_only.charge(payer(who, kHome), 20, 0));
}

TEST_CASE("budgets that have refilled are forgotten", "[server]") {
  EditLedger ledger({10, 20}, 4);
  EditPayer fresh = payer(0, {});
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

TEST_CASE("huge budgets do not overflow", "[server]") {
  EditLedger ledger({~0ULL, ~0ULL}, ~0ULL);
  CHECK_FALSE(ledger.charge(payer(1, kHome), 1'000'000, 0));
  EditLedger times({100, 4'000}, ~0ULL);
  CHECK_FALSE(times.charge(payer(1, kHome), 4'000, 0));
}

}  // namespace
}  // namespace runstone
