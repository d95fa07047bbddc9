#include "protocol/codec/handshake.hpp"

#include <sodium.h>

#include <string_view>

namespace runstone {
namespace {

static_assert(crypto_sign_PUBLICKEYBYTES == kKeyBytes && crypto_sign_BYTES == kSignatureBytes);
static_assert(crypto_sign_SEEDBYTES == std::tuple_size_v<KeySeed>);
static_assert(crypto_sign_SECRETKEYBYTES == std::tuple_size_v<decltype(KeyPair::secret_key)>);

void need_sodium() {
  static const bool ready = sodium_init() >= 0;  // safe from several threads
  RUNSTONE_ASSERT(ready);
}

void add_text(ByteWriter& out, std::string_view text) {
  out.varint(text.size());
  out.bytes(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Bytes transcript(std::string_view role, const Hello& hello, const Welcome& welcome) {
  Bytes bytes;
  ByteWriter out(bytes);
  add_text(out, role);
  out.u32(hello.protocol);
  out.bytes(hello.key);
  out.u64(hello.instance);
  out.bytes(hello.nonce);
  add_text(out, hello.name);
  out.u8(hello.encodings);
  out.u32(welcome.protocol);
  out.bytes(welcome.world_id);
  out.u32(welcome.epoch);
  out.u64(welcome.durable);
  out.u64(welcome.head);
  out.u16(welcome.chunk_edge);
  out.u8(static_cast<std::uint8_t>(welcome.encoding));
  out.bytes(welcome.server_key);
  out.bytes(welcome.challenge);
  return bytes;
}

}  // namespace

KeyPair key_pair_of(const KeySeed& seed) {
  need_sodium();
  KeyPair keys;
  crypto_sign_seed_keypair(keys.public_key.data(), keys.secret_key.data(), seed.data());
  return keys;
}

Bytes server_transcript(const Hello& hello, const Welcome& welcome) {
  return transcript("runstone server v1", hello, welcome);
}
Bytes client_transcript(const Hello& hello, const Welcome& welcome) {
  return transcript("runstone client v1", hello, welcome);
}

Signature sign(const KeyPair& keys, ByteView bytes) {
  need_sodium();
  Signature signature{};
  crypto_sign_detached(signature.data(), nullptr, bytes.data(), bytes.size(), keys.secret_key.data());
  return signature;
}

bool verify(const PublicKey& key, ByteView bytes, const Signature& signature) {
  need_sodium();
  return crypto_sign_verify_detached(signature.data(), bytes.data(), bytes.size(), key.data()) == 0;
}

}  // namespace runstone
