#include <catch2/catch.hpp>

#include <functional>

#include "protocol/codec/handshake.hpp"
#include "tests/support/codec/random_message.hpp"
#include "tests/support/core/hex.hpp"

namespace runstone::test {
namespace {

KeyPair keys_of(std::uint8_t byte) {
  KeySeed seed;
  seed.fill(byte);
  return key_pair_of(seed);
}

struct Exchange {
  KeyPair server = keys_of(1), client = keys_of(2);
  Hello hello;
  Welcome welcome;
  ClientAuth proof;

  Exchange() {
    SplitMix64 rng{5};
    hello = random_message<Hello>(rng);
    welcome = random_message<Welcome>(rng);
    hello.key = client.public_key;
    welcome.server_key = server.public_key;
    sign_both();
  }
  void sign_both() {
    welcome.signature = sign(server, server_transcript(hello, welcome, std::nullopt));
    proof.signature = sign(client, client_transcript(hello, welcome, std::nullopt));
  }
  bool server_proven() const {
    return verify(welcome.server_key, server_transcript(hello, welcome, std::nullopt),
                  welcome.signature);
  }
  bool client_proven() const {
    return verify(hello.key, client_transcript(hello, welcome, std::nullopt), proof.signature);
  }
};

}  // namespace

TEST_CASE("keys and signatures are those of RFC 8032", "[protocol]") {
  KeySeed seed;
  const Bytes bytes = from_hex("9d61b19deffd5a60ba844af492ec2cc44449c5697b326919703bac031cae7f60");
  std::copy(bytes.begin(), bytes.end(), seed.begin());
  const KeyPair keys = key_pair_of(seed);
  CHECK(to_hex(keys.public_key) ==
        "d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a");
  CHECK(to_hex(sign(keys, {})) ==
        "e5564300c360ac729086e2cc806e828a84877f1eb8e5d974d873e065224901555fb8821590a33bacc61e39701c"
        "f9b46b"
        "d25bf5f0595bbe24655141438e7a100b");
  CHECK(verify(keys.public_key, {}, sign(keys, {})));
}

TEST_CASE("both sides prove who they are", "[protocol]") {
  const Exchange exchange;
  CHECK(exchange.server_proven());
  CHECK(exchange.client_proven());
}

TEST_CASE("a change of any field of Hello or Welcome on the way breaks both signatures",
          "[protocol]") {
  const std::vector<std::function<void(Exchange&)>> changes = {
      [](Exchange& e) { e.hello.protocol ^= 1; },
      [](Exchange& e) { e.hello.instance ^= 1; },
      [](Exchange& e) { e.hello.nonce[31] ^= 1; },
      [](Exchange& e) { e.hello.name += "x"; },
      [](Exchange& e) { e.hello.encodings ^= 1; },
      [](Exchange& e) { e.hello.features ^= 1; },
      [](Exchange& e) { e.hello.features ^= 1ULL << 63; },
      [](Exchange& e) { e.welcome.protocol ^= 1; },
      [](Exchange& e) { e.welcome.world_id[0] ^= 1; },
      [](Exchange& e) { e.welcome.epoch ^= 1; },
      [](Exchange& e) { e.welcome.durable ^= 1; },
      [](Exchange& e) { e.welcome.head ^= 1; },
      [](Exchange& e) { e.welcome.chunk_edge ^= 48; },
      [](Exchange& e) { e.welcome.heights.y_min ^= 1; },
      [](Exchange& e) { e.welcome.heights.y_max ^= 1; },
      [](Exchange& e) { e.welcome.spawn.x += 1; },
      [](Exchange& e) { e.welcome.spawn.y += 1; },
      [](Exchange& e) { e.welcome.spawn.z += 1; },
      [](Exchange& e) {
        REQUIRE(
            e.welcome.materials.add({"bait", {1, 2, 3, 255}, Visibility::opaque, std::nullopt}));
      },
      [](Exchange& e) { e.welcome.challenge[0] ^= 1; },
      [](Exchange& e) {
        e.welcome.encoding =
            e.welcome.encoding == ChunkEncoding::raw ? ChunkEncoding::packed : ChunkEncoding::raw;
      },
      [](Exchange& e) { e.welcome.edit_volume_max ^= 1; },
      [](Exchange& e) { e.welcome.edit_budget.per_second ^= 1; },
      [](Exchange& e) { e.welcome.edit_budget.burst ^= 1; },
      [](Exchange& e) { e.welcome.view_radius_max ^= 1; },
      [](Exchange& e) { e.welcome.features ^= 1; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CAPTURE(i);
    Exchange exchange;
    changes[i](exchange);
    CHECK_FALSE(exchange.server_proven());
    CHECK_FALSE(exchange.client_proven());
    exchange.sign_both();  // signed again, the changed fields verify
    CHECK(exchange.server_proven());
    CHECK(exchange.client_proven());
  }
}

TEST_CASE("a signature of another key is refused on both sides", "[protocol]") {
  Exchange exchange;
  exchange.welcome.server_key = keys_of(3).public_key;
  CHECK_FALSE(exchange.server_proven());
  CHECK_FALSE(exchange.client_proven());
  exchange = {};
  exchange.hello.key = keys_of(3).public_key;
  CHECK_FALSE(exchange.server_proven());
  CHECK_FALSE(exchange.client_proven());
}

TEST_CASE("a signature made for one role is invalid for the other", "[protocol]") {
  Exchange exchange;
  const Signature of_client = exchange.proof.signature;
  // Both sides have the same key: only the label differs.
  exchange.server = exchange.client;
  exchange.welcome.server_key = exchange.client.public_key;
  exchange.sign_both();
  exchange.welcome.signature = exchange.proof.signature;
  CHECK_FALSE(exchange.server_proven());
  CHECK(of_client != exchange.proof.signature);
}

TEST_CASE("a recorded signature is invalid in the next handshake", "[protocol]") {
  const Exchange recorded;
  Exchange next;
  next.hello.nonce[0] ^= 0x55;  // an honest client draws a new nonce
  next.welcome.signature = recorded.welcome.signature;
  CHECK_FALSE(next.server_proven());
  next = {};
  next.welcome.challenge[0] ^= 0x55;  // an honest server draws a new challenge
  next.proof = recorded.proof;
  CHECK_FALSE(next.client_proven());
}

TEST_CASE("a flipped bit of a signature breaks it", "[protocol]") {
  Exchange exchange;
  for (std::size_t i = 0; i < kSignatureBytes; ++i) {
    exchange.proof.signature[i] ^= 0x10;
    CHECK_FALSE(exchange.client_proven());
    exchange.proof.signature[i] ^= 0x10;
  }
  CHECK(exchange.client_proven());
}

}  // namespace runstone::test
