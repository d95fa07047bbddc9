// Chat text: what a line of the chat may say. The server refuses other lines; a client calls the
// same function before it sends one.
#pragma once
#include <string>
#include <string_view>

#include "common/core/result.hpp"

namespace runstone {

/// Returns the line without blanks at its ends. Fails, with the reason as the end of the sentence
/// "the line is not sent: ", if the line
///   - is empty, or has more than kChatBytesMax bytes;
///   - is no UTF-8 text, or has control characters;
///   - has characters that are invisible or change the direction of the text
///     (has_unseen_character), because two lines must not look the same, and no line may change how
///     others look.
/// Cost: O(bytes).
Result<std::string, std::string> chat_text(std::string_view line);

}  // namespace runstone
