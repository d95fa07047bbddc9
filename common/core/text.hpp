// Text from outside: names and messages that end in log lines, on terminals and on screens.
#pragma once
#include <cstddef>
#include <string_view>

namespace runstone {

/// Well-formed UTF-8 (Unicode 15, table 3-7) without control characters (C0, DEL, C1), so that it can neither
/// break a log line nor steer a terminal. Empty text passes. O(bytes).
bool is_printable_utf8(std::string_view text);

/// The longest start of well-formed `text` that has at most `bytes_max` bytes and cuts no character.
std::string_view cut_utf8(std::string_view text, std::size_t bytes_max);

}  // namespace runstone
