// Handshake: who is who. Ed25519 keys (libsodium) on both sides from the first version on; randomness comes
// in as an argument, so that tests are repeatable.
//   client -> hello(key, nonce)    server -> welcome(server key, challenge, signature over the server
//   transcript) client -> proof(signature over the client transcript)    server -> ready(author)
// Transcripts bind both keys, both random values, the world, epoch and protocol version, and name their role,
// so that no signature can be replayed elsewhere or for the other side.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

using KeySeed = std::array<std::uint8_t, 32>;

struct KeyPair {
  PublicKey public_key{};
  std::array<std::uint8_t, 64> secret_key{};
};

/// Deterministic: the seed is the identity and must stay secret.
KeyPair key_pair_of(const KeySeed& seed);

/// "runstone server v1" + every field both sides know after welcome except the signature.
Bytes server_transcript(const Hello& hello, const Welcome& welcome);
/// "runstone client v1" + the same fields.
Bytes client_transcript(const Hello& hello, const Welcome& welcome);

Signature sign(const KeyPair& keys, ByteView transcript);
bool verify(const PublicKey& key, ByteView transcript, const Signature& signature);

}  // namespace runstone
