// The lines of an answer for a client.
#pragma once
#include <string>
#include <vector>

namespace runstone {

/// Splits a text at its line breaks. A line that is longer than kCommandLineBytesMax goes on in
/// further lines, because no message has longer ones.
std::vector<std::string> answer_lines(const std::string& text);

}  // namespace runstone
