// Key fingerprint: a short text for a public key that people read aloud, compare and recognise. A
// name can be imitated; a key with the same fingerprint takes about 2^60 attempts.
// Source: fingerprints of SSH keys (RFC 4716, section 4); the digits are Crockford's base 32, which
// has no I, L, O and U.
#pragma once
#include <string>

#include "protocol/codec/messages.hpp"

namespace runstone {

/// Returns the first 60 bits of BLAKE2b-256 of the key, high bits first, as twelve digits in three
/// groups: "9M1Q-Z7CR-04KD".
std::string key_fingerprint(const PublicKey& key);

}  // namespace runstone
