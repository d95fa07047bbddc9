// Key transfer messages: a player's secret key on its way to another device of the player. One
// device leaves it at the server, sealed with a one-time code that the player carries; the other
// device fetches it once. The server never has the code, so it cannot open what it keeps.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "common/core/bytes.hpp"
#include "protocol/limits.hpp"

namespace runstone {

/// The place of a sealed key at the server. It follows from the code, and the code does not follow
/// from it.
using KeySlot = std::array<std::uint8_t, kKeySlotBytes>;

/// Asks for the key in a slot, in place of ClientAuth.
struct KeyRequest {
  KeySlot slot{};
  friend bool operator==(const KeyRequest&, const KeyRequest&) = default;
};
struct SealedKey {
  Bytes sealed;  // 1 .. kSealedKeyBytesMax
  friend bool operator==(const SealedKey&, const SealedKey&) = default;
};

/// Leaves a sealed key, in place of ClientAuth.
struct KeyDeposit {
  KeySlot slot{};
  Bytes sealed;                                           // 1 .. kSealedKeyBytesMax
  std::array<std::uint8_t, kSignatureBytes> signature{};  // over the client transcript
  friend bool operator==(const KeyDeposit&, const KeyDeposit&) = default;
};
struct KeyDeposited {
  std::uint32_t seconds = 0;  // for so long the key can be fetched, once; 0: refused
  std::string text;           // the reason if it was refused; 0 .. kTextBytesMax bytes
  friend bool operator==(const KeyDeposited&, const KeyDeposited&) = default;
};

}  // namespace runstone
