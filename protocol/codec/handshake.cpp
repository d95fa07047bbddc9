#include "protocol/codec/handshake.hpp"

#include <sodium.h>

#include <string_view>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

static_assert(crypto_sign_PUBLICKEYBYTES == kPublicKeyBytes &&
              crypto_sign_BYTES == kSignatureBytes);
static_assert(crypto_sign_SEEDBYTES == std::tuple_size_v<KeySeed>);
static_assert(crypto_sign_SECRETKEYBYTES == std::tuple_size_v<decltype(KeyPair::secret_key)>);

void need_sodium() {
  static const bool ready = sodium_init() >= 0;  // runs once; other threads wait
  RUNSTONE_ASSERT(ready);
}

// Each field follows its length (u32), so two different handshakes never have the same bytes.
class Transcript {
 public:
  explicit Transcript(std::string_view label) : writer_(bytes_) { text(label); }
  void field(ByteView bytes) {
    writer_.u32(static_cast<std::uint32_t>(bytes.size()));
    writer_.bytes(bytes);
  }
  void text(std::string_view text) {
    field(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }
  /// Appends v as `bytes` bytes, little-endian.
  void number(std::uint64_t v, std::uint32_t bytes) {
    writer_.u32(bytes);
    for (std::uint32_t i = 0; i < bytes; ++i) writer_.u8(static_cast<std::uint8_t>(v >> (8 * i)));
  }
  void number(double v) {
    writer_.u32(sizeof v);
    writer_.f64(v);
  }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
  ByteWriter writer_;
};

// The order is that of the schema. docs/protocol.md lists it.
Bytes transcript_of(std::string_view label, const Hello& hello, const Welcome& welcome,
                    const std::optional<ChannelBinding>& binding) {
  Transcript t(label);
  t.number(hello.protocol, 4);
  t.field(hello.key);
  t.number(hello.instance, 8);
  t.field(hello.nonce);
  t.text(hello.name);
  t.number(hello.encodings, 1);
  t.number(hello.features, 8);
  t.number(welcome.protocol, 4);
  t.field(welcome.world_id);
  t.number(welcome.epoch, 4);
  t.number(welcome.durable, 8);
  t.number(welcome.head, 8);
  t.number(welcome.chunk_edge, 2);
  t.number(static_cast<std::uint32_t>(welcome.heights.y_min), 4);
  t.number(static_cast<std::uint32_t>(welcome.heights.y_max), 4);
  t.number(welcome.spawn.x);
  t.number(welcome.spawn.y);
  t.number(welcome.spawn.z);
  t.number(welcome.materials.size(), 4);
  for (const MaterialInfo& row : welcome.materials.rows()) {
    t.text(row.name);
    t.field(row.colour);
    t.number(static_cast<std::uint8_t>(row.visibility), 1);
  }
  t.field(welcome.server_key);
  t.field(welcome.challenge);
  t.number(static_cast<std::uint8_t>(welcome.encoding), 1);
  t.number(welcome.edit_volume_max, 8);
  t.number(welcome.edit_budget.per_second, 8);
  t.number(welcome.edit_budget.burst, 8);
  t.number(welcome.view_radius_max, 1);
  t.number(welcome.features, 8);
  t.field(binding ? ByteView(*binding) : ByteView());
  return t.take();
}

}  // namespace

KeyPair key_pair_of(const KeySeed& seed) {
  need_sodium();
  KeyPair keys;
  crypto_sign_seed_keypair(keys.public_key.data(), keys.secret_key.data(), seed.data());
  return keys;
}

Bytes server_transcript(const Hello& hello, const Welcome& welcome,
                        const std::optional<ChannelBinding>& binding) {
  return transcript_of("runstone server v2", hello, welcome, binding);
}
Bytes client_transcript(const Hello& hello, const Welcome& welcome,
                        const std::optional<ChannelBinding>& binding) {
  return transcript_of("runstone client v2", hello, welcome, binding);
}

Signature sign(const KeyPair& keys, ByteView transcript) {
  need_sodium();
  Signature signature{};
  crypto_sign_detached(signature.data(), nullptr, transcript.data(), transcript.size(),
                       keys.secret_key.data());
  return signature;
}

bool verify(const PublicKey& key, ByteView transcript, const Signature& signature) {
  need_sodium();
  return crypto_sign_verify_detached(signature.data(), transcript.data(), transcript.size(),
                                     key.data()) == 0;
}

}  // namespace runstone
