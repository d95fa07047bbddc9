// Output files: reports, lists and exports that a program writes where its user says. A mistyped
// name must not destroy a world, so databases and keys are never overwritten.
#pragma once
#include <string>
#include <string_view>

#include "common/core/result.hpp"

namespace runstone {

/// Returns why no output may be written to `file`, or an empty string. It may not be
///   - a file that begins like an SQLite database,
///   - called *.sqlite, *.sqlite-wal, *.sqlite-shm or *.key,
///   - a folder.
/// The text does not repeat the name of the file.
std::string output_refusal(const std::string& file);

/// Writes the file completely or not at all: a finished file replaces the old one. Fails as
/// output_refusal() says, or if it cannot be written; the error begins with the name of the file.
Result<void, std::string> write_output_file(const std::string& file, std::string_view bytes);

}  // namespace runstone
