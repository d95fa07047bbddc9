// Handshake: each side proves that it has the secret key of its Ed25519 identity (libsodium).
// Randomness is an argument, so that tests are repeatable.
//   client -> Hello(key, nonce)
//   server -> Welcome(server key, challenge, signature over the server transcript)
//   client -> ClientAuth(signature over the client transcript)
//   server -> SessionAccepted(author)
// A transcript contains both keys, both random values, the world, the epoch, the protocol version,
// the role of its signer and, if the connection is encrypted, what identifies it. So a signature
// cannot be replayed in another session, relayed to another connection or serve as the other
// side's.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "common/core/bytes.hpp"
#include "common/core/channel_binding.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

using KeySeed = std::array<std::uint8_t, 32>;

struct KeyPair {
  PublicKey public_key{};
  std::array<std::uint8_t, 64> secret_key{};
};

/// Returns the key pair of a seed. It is deterministic: the seed is the identity and must stay
/// secret.
KeyPair key_pair_of(const KeySeed& seed);

/// Returns "runstone server v2" and all fields that both sides know after Welcome, without the
/// signature. `binding` is nullopt if the connection is not encrypted.
Bytes server_transcript(const Hello& hello, const Welcome& welcome,
                        const std::optional<ChannelBinding>& binding);
/// Returns "runstone client v2" and the fields of server_transcript().
Bytes client_transcript(const Hello& hello, const Welcome& welcome,
                        const std::optional<ChannelBinding>& binding);

/// Returns the signature over a transcript.
Signature sign(const KeyPair& keys, ByteView transcript);
/// Returns true if the signature over the transcript was made with the secret key of `key`.
bool verify(const PublicKey& key, ByteView transcript, const Signature& signature);

}  // namespace runstone
