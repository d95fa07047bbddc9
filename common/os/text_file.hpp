// Text files that people write: scripts, passwords, keys, settings, lists. Editors differ in what
// they put around the text, so there is one way to read it.
#pragma once
#include <cstddef>
#include <istream>
#include <string>

#include "common/core/result.hpp"
#include "common/os/private_file.hpp"

namespace runstone {

/// The most bytes of a text that is read as a whole. Larger ones were not written by people.
inline constexpr std::size_t kTextFileBytesMax = std::size_t{16} << 20;
/// The most bytes of a password or an exported key.
inline constexpr std::size_t kFirstLineBytesMax = 4096;

/// Returns the text of the bytes of a file: without the byte order mark of UTF-8, and with a line
/// feed at the end of a line where the file has a carriage return before it. Fails if the bytes
/// begin with a byte order mark of UTF-16 or UTF-32. The error says what to do and does not name
/// the file.
Result<std::string, std::string> text_of_bytes(std::string bytes);

/// Reads a text file. Fails with a line that begins with the name of the file if read_file() fails,
/// or if it is not in UTF-8 as text_of_bytes() says.
Result<std::string, std::string> read_text_file(const std::string& file, std::size_t bytes_max,
                                                FileKinds kinds = FileKinds::regular_or_pipe);

/// Removes what text_of_bytes() leaves out from a line that was read from a stream without its line
/// feed: a byte order mark before it, and a carriage return behind it.
void trim_line(std::string& line);

/// Returns the first line of a file, for passwords and keys. Fails as read_text_file() does, or if
/// that line is empty.
Result<std::string, std::string> read_first_line(const std::string& file);

/// Returns the first line of a stream without its end, at most kFirstLineBytesMax bytes of it, or
/// an empty text. Reads no further.
std::string first_line_of(std::istream& in);

}  // namespace runstone
