// Hex digits as bytes, for golden bytes; common/core/hex.hpp goes the other way.
#pragma once
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/core/hex.hpp"

namespace runstone::test {

/// Blanks and line ends are skipped. Throws on anything else that is not a hex digit, and on half a byte.
inline Bytes from_hex(std::string_view text) {
  Bytes out;
  int high = -1;
  for (const char c : text) {
    if (c == ' ' || c == '\n') continue;
    const std::size_t digit = std::string_view("0123456789abcdef").find(c);
    if (digit == std::string_view::npos) throw std::invalid_argument("not a hex digit");
    if (high < 0) {
      high = static_cast<int>(digit);
    } else {
      out.push_back(static_cast<std::uint8_t>(high * 16 + static_cast<int>(digit)));
      high = -1;
    }
  }
  if (high >= 0) throw std::invalid_argument("half a byte");
  return out;
}

}  // namespace runstone::test
