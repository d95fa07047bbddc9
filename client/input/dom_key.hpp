// The keys of a page: browsers name a key by two texts, KeyboardEvent.code and KeyboardEvent.key.
// Pure.
#pragma once
#include <string_view>

#include "client/input/key.hpp"

namespace runstone {

/// Returns the key at this place of the keyboard, such as "KeyW", "Digit1" or "ArrowLeft", or
/// Key::unknown.
Key key_of_code(std::string_view code);
/// Returns the key with this letter or digit in the user's layout, such as "w" or "1". Returns
/// `place` if the text is no letter and no digit of ASCII.
Key key_of_text(std::string_view text, Key place);

}  // namespace runstone
