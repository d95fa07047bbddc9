// Key transfer: `runstone-client key send` and `key receive`, which move a player's key to another
// device by a one-time code. The functions wait for the network, kKeyTransferMs at most.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "client/app/key_options.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/handshake.hpp"

namespace runstone {

inline constexpr std::int64_t kKeyTransferMs = 20'000;

/// Leaves the key at the server and prints the code. Fails, and may throw, with one line for the
/// user.
Result<void, std::string> send_key(const KeyCommand& command, std::ostream& out);

/// Fetches the key of the code and writes the key file. Fails, and may throw, with one line for the
/// user. If the file exists or its folder cannot be written, nothing is fetched and the code stays
/// valid.
Result<KeySeed, std::string> receive_key(const KeyCommand& command, std::ostream& out);

}  // namespace runstone
