// Bytes as text: two hex digits for each byte.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "common/core/bytes.hpp"

namespace runstone {

/// Returns digits in lower case.
std::string to_hex(ByteView bytes);

/// Fills `out` from the digits. Returns false unless the text is exactly so many digits of either
/// case.
bool read_hex(std::string_view digits, std::span<std::uint8_t> out);

}  // namespace runstone
