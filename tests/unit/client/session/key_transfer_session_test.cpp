#include "client/session/key_transfer_session.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/key_fingerprint.hpp"
#include "tests/support/codec/test_keys.hpp"

using namespace runstone;
using runstone::test::keys;

namespace {

const KeySlot kTransferSlot{1, 2, 3};
const ChannelBinding kTransferBinding{4};

/// A session, and its server played by the test.
struct TransferFixture {
  explicit TransferFixture(KeyTransferSession::Request request,
                           std::map<WorldId, PublicKey> pinned = {})
      : session(keys(1), std::move(pinned), std::move(request)) {
    session.connected({5}, kTransferBinding);
    const auto sent = session.take_outgoing();
    REQUIRE(sent.size() == 1);
    hello = std::get<Hello>(sent[0]);
  }
  void welcome(std::uint64_t features = kFeatureKeyTransfer, const KeyPair& server = keys(9)) {
    sent_welcome.features = features;
    sent_welcome.server_key = server.public_key;
    sent_welcome.signature = sign(server, server_transcript(hello, sent_welcome, kTransferBinding));
    session.receive(sent_welcome);
  }
  std::string failure() const {
    REQUIRE(session.outcome().has_value());
    REQUIRE_FALSE(session.outcome()->has_value());
    return session.outcome()->error();
  }

  KeyTransferSession session;
  Hello hello;
  Welcome sent_welcome;
};

KeyDeposit some_deposit() { return {kTransferSlot, {7, 8}, {}}; }

}  // namespace

TEST_CASE("a deposit is signed, and its answer is the outcome", "[session]") {
  TransferFixture test(some_deposit());
  CHECK(test.hello.name == key_fingerprint(keys(1).public_key));
  CHECK(test.hello.features == kFeatureKeyTransfer);
  test.welcome();
  const auto sent = test.session.take_outgoing();
  REQUIRE(sent.size() == 1);
  const auto& deposit = std::get<KeyDeposit>(sent[0]);
  CHECK(deposit.slot == kTransferSlot);
  CHECK(verify(keys(1).public_key,
               client_transcript(test.hello, test.sent_welcome, kTransferBinding),
               deposit.signature));
  CHECK_FALSE(test.session.outcome().has_value());
  test.session.receive(KeyDeposited{600, ""});
  test.session.disconnected("closed");
  REQUIRE(test.session.outcome()->has_value());
  CHECK(std::get<KeyDeposited>(**test.session.outcome()).seconds == 600);
  CHECK(test.session.pinned().at(test.sent_welcome.world_id) == keys(9).public_key);
}

TEST_CASE("a request sends its slot and takes the sealed key", "[session]") {
  TransferFixture test(KeyRequest{kTransferSlot});
  test.welcome();
  const auto sent = test.session.take_outgoing();
  REQUIRE(sent.size() == 1);
  CHECK(std::get<KeyRequest>(sent[0]).slot == kTransferSlot);
  test.session.receive(SealedKey{{1, 2}});
  CHECK(std::get<SealedKey>(**test.session.outcome()).sealed == Bytes{1, 2});
}

TEST_CASE("a transfer that the server refuses or breaks off fails with the reason", "[session]") {
  SECTION("a goodbye") {
    TransferFixture test(KeyRequest{kTransferSlot});
    test.welcome();
    test.session.receive(Goodbye{GoodbyeReason::not_admitted, "no key is here"});
    CHECK(test.failure() == "the server refused: no key is here");
  }
  SECTION("a refused deposit") {
    TransferFixture test(some_deposit());
    test.welcome();
    test.session.receive(KeyDeposited{0, "too many"});
    CHECK(test.failure() == "the server refused: too many");
  }
  SECTION("a server that does not know the feature") {
    TransferFixture test(some_deposit());
    test.welcome(0);
    CHECK(test.failure() == "the server passes no keys to other devices");
    CHECK(test.session.take_outgoing().empty());
  }
  SECTION("an impostor") {
    TransferFixture test(some_deposit(), {{WorldId{}, keys(8).public_key}});
    test.welcome();
    CHECK(test.failure().find("impostor") != std::string::npos);
    CHECK(test.session.take_outgoing().empty());
  }
  SECTION("the answer to another request") {
    TransferFixture test(some_deposit());
    test.welcome();
    test.session.receive(SealedKey{{1}});
    CHECK(test.failure() == "the server sent an unexpected message");
  }
  SECTION("an answer before welcome") {
    TransferFixture test(some_deposit());
    test.session.receive(KeyDeposited{600, ""});
    CHECK(test.failure().starts_with("the server broke the protocol: "));
  }
  SECTION("a lost connection") {
    TransferFixture test(some_deposit());
    test.session.disconnected("cannot connect");
    CHECK(test.failure() == "cannot connect");
  }
}
