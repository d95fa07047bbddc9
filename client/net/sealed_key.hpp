// Sealed key: a player's secret key as one line of text, encrypted with a passphrase, so that it
// can be moved to another computer.
//   runstone-key-1:BASE64
// The base64 text (with padding) holds
//   u8 version 1, u32 operations, u32 memory in KiB, 16 bytes of salt: the costs and the salt of
//     Argon2id, which makes a key of 32 bytes from the passphrase;
//   24 bytes of nonce;
//   48 bytes: the seed of the Ed25519 key, encrypted by XChaCha20-Poly1305 with that key. All bytes
//     before are authenticated with it.
// Numbers are little-endian. The costs are bounded when a line is opened, because a hostile line
// could otherwise take all memory or hours.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "protocol/codec/handshake.hpp"

namespace runstone {

struct SealCost {
  std::uint32_t operations = 3;          // 1 .. 16
  std::uint32_t memory_kib = 256 << 10;  // 8 .. 1 << 20
};
inline constexpr std::uint32_t kSealOperationsMax = 16, kSealMemoryKibMax = 1 << 20;

/// Returns the line, without its end. Waits about a second. Fails if the memory is not there.
Result<std::string, std::string> seal_key(const KeySeed& seed, const std::string& passphrase,
                                          SealCost cost = {});
/// Returns the seed in a line; blanks around it are ignored. Fails if the line is damaged or of
/// another version, asks for too much, or if the passphrase is wrong. The error does not contain
/// the line.
Result<KeySeed, std::string> open_sealed_key(std::string_view line, const std::string& passphrase);

}  // namespace runstone
