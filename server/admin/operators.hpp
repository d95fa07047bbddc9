// Operators: the players who may give every command, by public key. Names are not unique and not proved; keys are.
#pragma once
#include <set>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Keys of 64 hexadecimal digits each, parted by blanks or commas; none is allowed. The error names the word that is no
/// key.
Result<std::set<PublicKey>, std::string> parse_operators(std::string_view text);

}  // namespace runstone
