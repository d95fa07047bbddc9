// Key file: a client's identity on disk, and the server keys it has come to trust.
//   KEY FILE          one line, 64 hex digits: the Ed25519 seed; made with mode 0600 where missing
//   KEY FILE.servers  one line per world: 32 hex digits world id, space, 64 hex digits server key
// Blocks on the disk; for start-up and shut-down. Throws std::runtime_error with the file's name.
#pragma once
#include <map>
#include <string>

#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Reads the key, or draws one and stores it. Refuses a file that others may read.
KeyPair load_or_create_key(const std::string& file);
/// A key for this process only.
KeyPair random_key();

/// Fresh randomness for hello.
Nonce random_nonce();
ClientInstance random_instance();

std::map<WorldId, PublicKey> load_pinned_servers(const std::string& key_file);
void save_pinned_servers(const std::string& key_file, const std::map<WorldId, PublicKey>& pinned);

}  // namespace runstone
