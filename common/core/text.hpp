// Checks for text from outside: names and messages that appear in log lines, on terminals and on
// screens.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace runstone {

/// Returns true if the text is well-formed UTF-8 (Unicode 15, table 3-7) without control characters
/// (C0, DEL, C1). Such text cannot break a log line or control a terminal. Empty text passes. Cost:
/// O(bytes).
bool is_printable_utf8(std::string_view text);

/// Returns the character at `at` and moves `at` behind it. Requires well-formed UTF-8, and `at`
/// below its size at the first byte of a character.
std::uint32_t next_character(std::string_view text, std::size_t& at);

/// Returns true if the text may be a name that people read and type: is_printable_utf8(), not
/// empty, without blanks at its ends, and without
///   - quotes (") and backslashes, because names stand in quotes in commands and log lines;
///   - characters that are invisible or change the direction of the text around them (Unicode's
///     default ignorable and bidirectional controls), because two names must not look the same.
/// Cost: O(bytes).
bool is_plain_name(std::string_view text);

/// Returns true if the text has a character that is invisible, that changes the direction of the
/// text around it, or that is a blank other than U+0020. Requires well-formed UTF-8. Cost:
/// O(bytes).
bool has_unseen_character(std::string_view text);

/// Returns the text with a question mark in place of each such character. Requires well-formed
/// UTF-8.
/// Cost: O(bytes).
std::string with_unseen_replaced(std::string_view text);

/// Returns the longest prefix of well-formed `text` that has at most `bytes_max` bytes and cuts no
/// character.
std::string_view cut_utf8(std::string_view text, std::size_t bytes_max);

}  // namespace runstone
