// Operators: the players who may give every command. They are known by public key, because a name
// may have no owner.
#pragma once
#include <set>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Parses keys of 64 hexadecimal digits each, separated by blanks or commas. An empty text has no
/// keys. The error names the word that is no key.
Result<std::set<PublicKey>, std::string> parse_operators(std::string_view text);

}  // namespace runstone
