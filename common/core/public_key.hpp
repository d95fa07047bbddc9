// PublicKey: the Ed25519 public key that identifies a player or a server.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace runstone {

inline constexpr std::size_t kPublicKeyBytes = 32;
using PublicKey = std::array<std::uint8_t, kPublicKeyBytes>;

}  // namespace runstone
