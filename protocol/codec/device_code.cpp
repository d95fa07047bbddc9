#include "protocol/codec/device_code.hpp"

#include <sodium.h>

#include <algorithm>

namespace runstone {
namespace {

constexpr std::string_view kCodeDigits = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
constexpr unsigned kCodeDigitBits = 5;
static_assert(kDeviceCodeBytes * 8 == kDeviceCodeDigits * kCodeDigitBits);
static_assert(kDeviceNonceBytes == crypto_aead_xchacha20poly1305_ietf_NPUBBYTES);
constexpr std::size_t kSealBytes = crypto_aead_xchacha20poly1305_ietf_ABYTES;

using CodeHash = std::array<std::uint8_t, crypto_generichash_BYTES>;
static_assert(std::tuple_size_v<CodeHash> == crypto_aead_xchacha20poly1305_ietf_KEYBYTES);

CodeHash code_hash(std::string_view label, std::string_view digits) {
  const std::string text = std::string(label) + std::string(digits);
  CodeHash hash{};
  crypto_generichash(hash.data(), hash.size(), reinterpret_cast<const unsigned char*>(text.data()),
                     text.size(), nullptr, 0);
  return hash;
}

CodeHash secret_of(std::string_view digits) { return code_hash("runstone device key v1", digits); }

/// Returns the digit that a typed character means. Capitals only.
char digit_meant(char c) {
  if (c == 'O') return '0';
  return c == 'I' || c == 'L' ? '1' : c;
}

}  // namespace

DeviceCode::DeviceCode(const std::array<std::uint8_t, kDeviceCodeBytes>& random) {
  unsigned bits = 0, bit_count = 0;
  for (const std::uint8_t byte : random) {
    bits = bits << 8 | byte;
    for (bit_count += 8; bit_count >= kCodeDigitBits; bit_count -= kCodeDigitBits)
      digits_ += kCodeDigits[bits >> (bit_count - kCodeDigitBits) & 31U];
  }
}

std::optional<DeviceCode> DeviceCode::parse(std::string_view text) {
  DeviceCode code;
  for (const char c : text) {
    if (c == ' ' || c == '-') continue;
    const char digit = digit_meant(c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c);
    const bool is_digit = kCodeDigits.find(digit) != std::string_view::npos;
    if (!is_digit || code.digits_.size() == kDeviceCodeDigits) return std::nullopt;
    code.digits_ += digit;
  }
  if (code.digits_.size() != kDeviceCodeDigits) return std::nullopt;
  return code;
}

std::string DeviceCode::text() const {
  constexpr std::size_t kGroup = 4;
  std::string out;
  for (std::size_t i = 0; i < digits_.size(); ++i) {
    if (i != 0 && i % kGroup == 0) out += '-';
    out += digits_[i];
  }
  return out;
}

KeySlot DeviceCode::slot() const {
  const CodeHash hash = code_hash("runstone device slot v1", digits_);
  KeySlot slot{};
  std::copy_n(hash.begin(), slot.size(), slot.begin());
  return slot;
}

Bytes DeviceCode::seal(const KeySeed& seed,
                       const std::array<std::uint8_t, kDeviceNonceBytes>& nonce) const {
  const KeySlot bound = slot();
  CodeHash secret = secret_of(digits_);
  Bytes out(nonce.begin(), nonce.end());
  out.resize(kDeviceNonceBytes + seed.size() + kSealBytes);
  crypto_aead_xchacha20poly1305_ietf_encrypt(out.data() + kDeviceNonceBytes, nullptr, seed.data(),
                                             seed.size(), bound.data(), bound.size(), nullptr,
                                             nonce.data(), secret.data());
  sodium_memzero(secret.data(), secret.size());
  return out;
}

std::optional<KeySeed> DeviceCode::open(ByteView sealed) const {
  KeySeed seed{};
  if (sealed.size() != kDeviceNonceBytes + seed.size() + kSealBytes) return std::nullopt;
  const KeySlot bound = slot();
  CodeHash secret = secret_of(digits_);
  const int opened = crypto_aead_xchacha20poly1305_ietf_decrypt(
      seed.data(), nullptr, nullptr, sealed.data() + kDeviceNonceBytes,
      sealed.size() - kDeviceNonceBytes, bound.data(), bound.size(), sealed.data(), secret.data());
  sodium_memzero(secret.data(), secret.size());
  if (opened != 0) return std::nullopt;
  return seed;
}

bool is_same_slot(const KeySlot& a, const KeySlot& b) {
  return sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace runstone
