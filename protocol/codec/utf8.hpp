// Names and texts from outside are shown to people: they must be UTF-8.
#pragma once
#include <string_view>

namespace runstone {

/// Well-formed UTF-8 (no overlong forms, surrogates or code points beyond U+10FFFF) without control
/// characters. Source of the table: The Unicode Standard, table 3-7.
bool is_utf8(std::string_view text);

}  // namespace runstone
