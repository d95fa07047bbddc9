// Keys for another device on the world strand.
#include <catch2/catch.hpp>

#include "server/world/people/key_deposits.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

constexpr AddressBlock kDesk = address_block_v4(0x0a000001), kCafe = address_block_v4(0x0b000001);
const KeySlot kSlot{1, 2, 3}, kOtherSlot{1, 2, 4};
const Bytes kSealed{7, 8, 9};

PublicKey transfer_player(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }

struct TransferBench : WorldBench {
  Welcome greet(SessionId session, std::uint8_t who, AddressBlock from) {
    server.connected(session, now(), from);
    Hello h = hello(who);
    h.features = kFeatureKeyTransfer;
    server.received(session, h, now());
    const auto welcome = environment.messages<Welcome>(session, 0);
    REQUIRE(welcome.size() == 1);
    return welcome[0];
  }
  void deposit(SessionId session, std::uint8_t who, const KeySlot& slot,
               AddressBlock from = kDesk) {
    Hello h = hello(who);
    h.features = kFeatureKeyTransfer;
    const Welcome welcome = greet(session, who, from);
    server.received(session, KeyDeposit{slot, kSealed, client_auth(who, h, welcome).signature},
                    now());
  }
  KeyDeposited deposited(SessionId session) const {
    const auto answers = environment.messages<KeyDeposited>(session, kEdge);
    REQUIRE(answers.size() == 1);
    return answers[0];
  }
  /// Returns what the slot held, or nothing.
  Bytes fetch(SessionId session, const KeySlot& slot, AddressBlock from = kCafe) {
    greet(session, 99, from);
    server.received(session, KeyRequest{slot}, now());
    REQUIRE(environment.closed.back().session == session);
    const auto answers = environment.messages<SealedKey>(session, kEdge);
    const bool is_too_often = environment.closed.back().text == kTooManyGuesses;
    CHECK(environment.closed.back().reason == (is_too_often      ? GoodbyeReason::flooding
                                               : answers.empty() ? GoodbyeReason::not_admitted
                                                                 : GoodbyeReason::closing));
    return answers.empty() ? Bytes() : answers[0].sealed;
  }
};

TEST_CASE("a key that one device leaves is fetched once, by whoever has the code", "[world]") {
  TransferBench bench;
  bench.deposit(1, 1, kSlot);
  CHECK(bench.deposited(1).seconds == 600);
  CHECK(bench.environment.closed.back().reason == GoodbyeReason::closing);
  CHECK(bench.server.session_count() == 0);
  CHECK(bench.fetch(2, kOtherSlot).empty());
  CHECK(bench.fetch(3, kSlot) == kSealed);
  CHECK(bench.fetch(4, kSlot).empty());
  CHECK(bench.environment.closed.back().text.find("used before") != std::string::npos);
  CHECK(bench.environment.came.empty());  // nobody joined the world
  CHECK(bench.environment.records.empty());
  CHECK(bench.environment.players.empty());
}

TEST_CASE("a deposit ends after ten minutes", "[world]") {
  TransferBench bench;
  bench.deposit(1, 1, kSlot);
  bench.time_us += kDepositUs;
  CHECK(bench.fetch(2, kSlot).empty());
}

TEST_CASE("a deposit needs the signature of its key", "[world]") {
  TransferBench bench;
  bench.greet(1, 1, kDesk);
  bench.server.received(1, KeyDeposit{kSlot, kSealed, {}}, bench.now());
  CHECK(bench.environment.closed.back().reason == GoodbyeReason::not_authenticated);
  CHECK(bench.environment.messages<KeyDeposited>(1, kEdge).empty());
  CHECK(bench.fetch(2, kSlot).empty());
}

TEST_CASE("who may not join leaves no key, and fetches one all the same", "[world]") {
  TransferBench bench;
  bench.deposit(1, 1, kSlot);
  REQUIRE(bench.server.changes()
              .change_rights(SetDefaultRole{kNobodyRole}, {}, 0, bench.now())
              .has_value());
  bench.deposit(2, 2, kOtherSlot);
  CHECK(bench.environment.closed.back().reason == GoodbyeReason::not_admitted);
  CHECK(bench.environment.messages<KeyDeposited>(2, kEdge).empty());
  CHECK(bench.fetch(3, kSlot) == kSealed);
}

TEST_CASE("a banned address fetches nothing, and a banned key leaves nothing", "[world]") {
  TransferBench bench;
  bench.deposit(1, 1, kSlot);
  const auto ban = [&](const RestrictionSubject& subject) {
    REQUIRE(bench.server.changes()
                .change_rights(Restrict{RestrictionKind::ban, subject, 0, ""}, {}, 0, bench.now())
                .has_value());
  };
  bench.greet(2, 99, kCafe);  // it is in the handshake when the ban comes
  ban(AddressRange{kCafe, 64});
  bench.server.received(2, KeyRequest{kSlot}, bench.now());
  CHECK(bench.environment.messages<SealedKey>(2, kEdge).empty());
  CHECK(bench.environment.closed.back().text == "your address is banned");
  ban(transfer_player(2));
  bench.deposit(3, 2, kOtherSlot);
  CHECK(bench.environment.messages<KeyDeposited>(3, kEdge).empty());
  CHECK(bench.fetch(4, kSlot, kDesk) == kSealed);
}

TEST_CASE("an address has few empty slots and few deposits", "[world]") {
  TransferBench bench;
  bench.deposit(1, 1, kSlot);
  SessionId session = 2;
  for (int i = 0; i < 10; ++i) REQUIRE(bench.fetch(session++, kOtherSlot).empty());
  CHECK(bench.fetch(session++, kSlot).empty());
  CHECK(bench.environment.closed.back().text.find("wait a minute") != std::string::npos);
  CHECK(bench.fetch(session++, kSlot, kDesk) == kSealed);
  for (std::uint8_t who = 2; who < 11; ++who) {
    bench.deposit(session, who, KeySlot{who});
    REQUIRE(bench.deposited(session++).seconds == 600);
  }
  bench.deposit(session, 11, KeySlot{11});
  CHECK(bench.deposited(session).seconds == 0);
  CHECK(bench.deposited(session).text.find("wait a minute") != std::string::npos);
  CHECK(bench.server.rights().refusals().size() == 1);
}

TEST_CASE("messages about keys in a wrong stage or without the feature end the session",
          "[world]") {
  TransferBench bench;
  const auto ends = [&](SessionId session, const Message& message) {
    bench.server.received(session, Message(message), bench.now());
    REQUIRE(bench.environment.closed.back().session == session);
    CHECK(bench.environment.closed.back().reason == GoodbyeReason::unexpected_message);
  };
  bench.server.connected(1, bench.now());
  bench.server.received(1, bench.hello(1), bench.now());
  ends(1, KeyRequest{kSlot});
  bench.join(2, 1);
  ends(2, KeyDeposit{kSlot, kSealed, {}});
  bench.server.connected(3, bench.now());
  ends(3, KeyRequest{kSlot});
}

}  // namespace
}  // namespace runstone::test
