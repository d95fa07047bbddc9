// Password key: what a client makes of a world's password and of the salt in Welcome, and sends in
// ClientAuth. The hash is slow on purpose and is computed by the client, so that whoever guesses
// passwords pays for each guess. docs/protocol.md has the algorithm and an example.
#pragma once
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "common/rights/join_password.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

inline constexpr std::size_t kPasswordCharactersMin = 8;
inline constexpr std::size_t kPasswordBytesMax = 512;

/// Returns the key: Argon2id (3 passes, 64 MiB, one lane) of the NFC of the password. Fails if the
/// password is not 1 .. kPasswordBytesMax bytes of printable UTF-8, or if there is too little
/// memory; the error does not contain the password. Cost: about a quarter of a second.
Result<PasswordKey, std::string> password_key(std::string_view password, const PasswordSalt& salt);

/// Returns the hash of a key, as a world keeps it.
PasswordHash hash_of(const PasswordKey& key);

/// Returns what a world keeps: the password as a hash of its key. Fails as password_key(), and if
/// the password has fewer than kPasswordCharactersMin characters.
Result<JoinPassword, std::string> join_password(std::string_view password, const PasswordSalt& salt,
                                                const std::string& role);

/// Returns true if the key is that of the password. Takes as long for wrong keys as for the right
/// one.
bool is_key_of(const JoinPassword& password, const PasswordKey& key);

}  // namespace runstone
