// The normal form of a text: NFC of Unicode (Unicode Standard Annex #15), made by utf8proc. A text
// has the same form whether a keyboard types a letter and its accent as one character or as two.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace runstone {

/// Returns the NFC. Requires well-formed UTF-8 without a zero byte. Cost: O(bytes).
std::string nfc_of(std::string_view text);

/// Returns the number of characters (code points). Requires well-formed UTF-8.
std::size_t character_count(std::string_view text);

}  // namespace runstone
