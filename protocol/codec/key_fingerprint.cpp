#include "protocol/codec/key_fingerprint.hpp"

#include <sodium.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace runstone {

std::string key_fingerprint(const PublicKey& key) {
  constexpr std::string_view kDigits = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
  constexpr unsigned kDigitCount = 12, kGroup = 4, kDigitBits = 5;
  std::array<std::uint8_t, crypto_generichash_BYTES> hash{};
  crypto_generichash(hash.data(), hash.size(), key.data(), key.size(), nullptr, 0);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits = bits << 8 | hash[i];
  std::string text;
  for (unsigned i = 0; i < kDigitCount; ++i) {
    if (i != 0 && i % kGroup == 0) text += '-';
    text += kDigits[bits >> (64 - kDigitBits * (i + 1)) & 31U];
  }
  return text;
}

}  // namespace runstone
