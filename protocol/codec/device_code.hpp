// Device code: the one-time code with which a player's key moves to another device. It names the
// slot at the server that holds the key, and opens the seal of the key. docs/protocol.md has the
// bytes.
// Pure: randomness is an argument.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/bytes.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/key_transfer_messages.hpp"

namespace runstone {

inline constexpr std::size_t kDeviceCodeDigits = 16;
inline constexpr std::size_t kDeviceCodeBytes = 10;  // 5 bits a digit
inline constexpr std::size_t kDeviceNonceBytes = 24;

class DeviceCode {
 public:
  /// Makes the code of these random bytes.
  explicit DeviceCode(const std::array<std::uint8_t, kDeviceCodeBytes>& random);
  /// Takes a code as people type it: in small letters too, with blanks and hyphens anywhere, and
  /// with O for 0, and I or L for 1. Returns nullopt if it is no code.
  static std::optional<DeviceCode> parse(std::string_view text);

  /// Returns four groups of four digits, such as "7K2M-Q0CR-04KD-Z9XW".
  std::string text() const;
  KeySlot slot() const;
  /// Encrypts the seed of a key. `nonce` is random.
  Bytes seal(const KeySeed& seed, const std::array<std::uint8_t, kDeviceNonceBytes>& nonce) const;
  /// Returns the seed, or nullopt if it was not sealed with this code.
  std::optional<KeySeed> open(ByteView sealed) const;

 private:
  DeviceCode() = default;
  std::string digits_;  // kDeviceCodeDigits of Crockford's base 32, in capitals
};

/// Compares slots in a time that does not depend on their bytes.
bool is_same_slot(const KeySlot& a, const KeySlot& b);

}  // namespace runstone
