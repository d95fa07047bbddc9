// line_text: the text that is the rest of a command's line.
#pragma once
#include <string>

#include "common/core/result.hpp"
#include "server/admin/word_reader.hpp"

namespace runstone {

/// Returns the rest of the line, as chat_text() takes it. A text that is quoted as a whole is taken
/// without its quotes. Fails, with a sentence that begins with the command, if it is no line of chat.
Result<std::string, std::string> line_text(const WordReader& reader);

}  // namespace runstone
