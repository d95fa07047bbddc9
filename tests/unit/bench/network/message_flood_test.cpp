#include "bench/network/message_flood.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <string>

using namespace runstone;
using namespace runstone::bench;

TEST_CASE("a flood has every kind of message that a client may send", "[flood]") {
  std::set<std::string> names;
  for (const MessageKind kind : client_kinds()) names.insert(info_of(kind).name);
  CHECK(names.contains("Hello"));
  CHECK(names.contains("EditRequest"));
  CHECK(names.contains("Goodbye"));  // both sides send it
  CHECK(names.contains("KeyDeposit"));
  CHECK_FALSE(names.contains("Commit"));
}

TEST_CASE("a server accepts the form of every message of a flood", "[flood]") {
  const auto edge = static_cast<std::uint16_t>(GENERATE(16, 32, 64));
  SplitMix64 random(edge);
  for (const MessageKind kind : client_kinds()) {
    FloodMessages messages(kind, edge, random);
    for (int i = 0; i < 200; ++i) {
      CAPTURE(edge, info_of(kind).name, i);
      const EncodedMessage encoded = encode_message(messages.next());
      REQUIRE(encoded.kind == kind);
      REQUIRE(decode_message(Sender::client, kind, *encoded.bytes, edge).has_value());
    }
  }
}

TEST_CASE("the edits of a flood are numbered from 1 in each session", "[flood]") {
  SplitMix64 random(1);
  FloodMessages messages(kKindOf<EditRequest>, 32, random);
  for (int session = 0; session < 2; ++session) {
    messages.restart();
    for (ClientSequence seq = 1; seq <= 100; ++seq)
      REQUIRE(std::get<EditRequest>(messages.next()).client_seq == seq);
  }
}
