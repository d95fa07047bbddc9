// Golden bytes written as hex digits; common/core/hex.hpp has the opposite conversion.
#pragma once
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/core/hex.hpp"

namespace runstone::test {

/// Returns the bytes. Blanks and line ends are skipped. Throws on any other character that is no
/// hex digit, and on half a byte.
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
