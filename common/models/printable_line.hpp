// Texts from models, and from programs that read them, as texts that may be shown. Thread: any.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace runstone {

/// Returns the text with a question mark in place of each byte that is_printable_utf8() does not
/// allow, at most `bytes_max` bytes of it. It cuts no character. Cost: O(bytes).
std::string printable_line(std::string_view text, std::size_t bytes_max);

}  // namespace runstone
