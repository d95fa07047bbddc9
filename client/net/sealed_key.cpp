#include "client/net/sealed_key.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>

#include "common/core/bytes.hpp"

namespace runstone {
namespace {

constexpr std::string_view kPrefix = "runstone-key-1:";
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kHeaderBytes =
    9 + crypto_pwhash_argon2id_SALTBYTES + crypto_aead_xchacha20poly1305_ietf_NPUBBYTES;
constexpr std::size_t kSealedBytes =
    std::tuple_size_v<KeySeed> + crypto_aead_xchacha20poly1305_ietf_ABYTES;
constexpr int kBase64 = sodium_base64_VARIANT_ORIGINAL;
using SealKey = std::array<std::uint8_t, crypto_aead_xchacha20poly1305_ietf_KEYBYTES>;

/// Makes the key of a passphrase. Returns false if there is too little memory.
bool make_seal_key(SealKey& key, const std::string& passphrase, const std::uint8_t* salt,
                   SealCost cost) {
  return crypto_pwhash(key.data(), key.size(), passphrase.data(), passphrase.size(), salt,
                       cost.operations, std::size_t{cost.memory_kib} << 10,
                       crypto_pwhash_ALG_ARGON2ID13) == 0;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

constexpr const char* kNoMemory = "there is too little memory for the passphrase's costs";

}  // namespace

Result<std::string, std::string> seal_key(const KeySeed& seed, const std::string& passphrase,
                                          SealCost cost) {
  if (sodium_init() < 0) return failure("libsodium cannot start");
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.u8(kVersion);
  writer.u32(cost.operations);
  writer.u32(cost.memory_kib);
  std::array<std::uint8_t, kHeaderBytes - 9> random{};
  randombytes_buf(random.data(), random.size());
  writer.bytes(random);
  SealKey key{};
  if (!make_seal_key(key, passphrase, random.data(), cost)) return failure(kNoMemory);
  bytes.resize(kHeaderBytes + kSealedBytes);
  crypto_aead_xchacha20poly1305_ietf_encrypt(
      bytes.data() + kHeaderBytes, nullptr, seed.data(), seed.size(), bytes.data(), kHeaderBytes,
      nullptr, random.data() + crypto_pwhash_argon2id_SALTBYTES, key.data());
  sodium_memzero(key.data(), key.size());
  std::string text(sodium_base64_encoded_len(bytes.size(), kBase64), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), kBase64);
  text.pop_back();  // the final zero
  return std::string(kPrefix) + text;
}

Result<KeySeed, std::string> open_sealed_key(std::string_view line, const std::string& passphrase) {
  if (sodium_init() < 0) return failure("libsodium cannot start");
  const std::string_view text = trimmed(line);
  if (!text.starts_with(kPrefix))
    return failure("this is no exported key of version 1: it begins with \"runstone-key-1:\"");
  const std::string_view base64 = text.substr(kPrefix.size());
  std::array<std::uint8_t, kHeaderBytes + kSealedBytes> bytes{};
  std::size_t size = 0;
  const char* end = nullptr;
  if (sodium_base642bin(bytes.data(), bytes.size(), base64.data(), base64.size(), nullptr, &size,
                        &end, kBase64) != 0 ||
      size != bytes.size() || end != base64.data() + base64.size())
    return failure("the exported key is damaged: it was cut, or characters were changed");
  ByteReader reader(bytes);
  const std::uint8_t version = reader.u8();
  SealCost cost;
  cost.operations = reader.u32();
  cost.memory_kib = reader.u32();
  if (version != kVersion || cost.operations == 0 || cost.operations > kSealOperationsMax ||
      cost.memory_kib < crypto_pwhash_argon2id_MEMLIMIT_MIN >> 10 ||
      cost.memory_kib > kSealMemoryKibMax)
    return failure("the exported key is damaged, or asks for too much memory or time");
  const std::uint8_t* const salt = bytes.data() + 9;
  SealKey key{};
  if (!make_seal_key(key, passphrase, salt, cost)) return failure(kNoMemory);
  KeySeed seed{};
  const int opened = crypto_aead_xchacha20poly1305_ietf_decrypt(
      seed.data(), nullptr, nullptr, bytes.data() + kHeaderBytes, kSealedBytes, bytes.data(),
      kHeaderBytes, salt + crypto_pwhash_argon2id_SALTBYTES, key.data());
  sodium_memzero(key.data(), key.size());
  if (opened != 0) return failure("the passphrase is wrong, or the exported key is damaged");
  return seed;
}

}  // namespace runstone
