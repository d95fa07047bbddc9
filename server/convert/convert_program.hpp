// runstone-convert: reads a build from a file of one format and writes it to a file of another, without
// a world (docs/formats.md).
#pragma once
#include <iosfwd>

namespace runstone {

/// Runs the program. Prints a line about the build to `out`, and errors to `err`. Returns the exit code:
/// 0, or 1 if a file cannot be read or written, or the code of the command line's library. An error
/// leaves an old file of that name as it was.
int convert_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace runstone
