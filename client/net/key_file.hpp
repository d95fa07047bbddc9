// Key file: the identity of a client on disk, and the server keys that it trusts.
//   KEY FILE          one line of 64 hex digits, the Ed25519 seed; created with mode 0600
//   KEY FILE.servers  one line per world: 32 hex digits of world id, a space, 64 hex digits of
//                     server key
// The functions wait for the disk, so they are for the start and the end of a program. They throw
// std::runtime_error with the file's name if a file cannot be read or written.
#pragma once
#include <map>
#include <string>

#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Reads the key, or creates the file with a random key. Throws if other users may read the file.
KeyPair load_or_create_key(const std::string& file);
/// Reads the seed of a key. Throws if the file is missing, or if other users may read it.
KeySeed load_key_seed(const std::string& file);
/// Throws if the file exists, or if its folder is missing or not writable.
void require_new_key_file(const std::string& file);
/// Writes a key file. Throws if the file exists.
void save_new_key(const std::string& file, const KeySeed& seed);
/// Writes a file that only its owner may read. It is on disk on return. Throws if the file exists.
void write_new_secret_file(const std::string& file, const std::string& text);
/// Returns a random key.
KeyPair random_key();

/// Random values for Hello.
Nonce random_nonce();
ClientInstance random_instance();

/// Returns the server key of each known world; empty if the file is missing.
std::map<WorldId, PublicKey> load_pinned_servers(const std::string& key_file);
/// Replaces the file of known server keys.
void save_pinned_servers(const std::string& key_file, const std::map<WorldId, PublicKey>& pinned);

}  // namespace runstone
