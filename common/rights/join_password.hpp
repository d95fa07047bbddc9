// JoinPassword: what a world keeps of its password. Clients make a key of 32 bytes from the
// password and the salt (protocol/codec/password_key.hpp). The world keeps only the hash of this
// key, so nobody can join with what its log, its database or a copy of them holds.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace runstone {

inline constexpr std::size_t kPasswordSaltBytes = 16;
inline constexpr std::size_t kPasswordHashBytes = 32;
using PasswordSalt = std::array<std::uint8_t, kPasswordSaltBytes>;
using PasswordHash = std::array<std::uint8_t, kPasswordHashBytes>;

struct JoinPassword {
  std::string role;     // of the players who join with it
  PasswordSalt salt{};  // random, drawn anew whenever a password is set
  PasswordHash hash{};  // BLAKE2b-256 of the key
  friend bool operator==(const JoinPassword&, const JoinPassword&) = default;
};

}  // namespace runstone
