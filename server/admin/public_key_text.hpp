// Public keys as text: 64 hexadecimal digits.
#pragma once
#include <optional>
#include <string_view>

#include "common/core/public_key.hpp"

namespace runstone {

/// Returns the key of 64 hexadecimal digits, or nullopt if the text is anything else.
std::optional<PublicKey> parse_public_key(std::string_view digits);

}  // namespace runstone
