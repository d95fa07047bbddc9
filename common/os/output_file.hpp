// Output files: reports, lists and exports that a program writes where its user says. A mistyped
// name must not destroy a world, so its files, databases and keys are never overwritten.
#pragma once
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "common/os/file_writer.hpp"

namespace runstone {

/// Returns why no output may be written to `file`, or an empty string. It may not be, and no
/// symbolic link at its end may lead to,
///   - a file that begins like an SQLite database,
///   - *.sqlite, *.sqlite-wal, *.sqlite-shm, *.sqlite-journal, *.durable, *.lock or *.key,
///   - a folder.
/// The text does not repeat the name of the file.
std::string output_refusal(const std::string& file);

/// Returns true if `file` is a device, a pipe or a descriptor of this process, which no new file can
/// replace.
bool is_written_in_place(const std::string& file);

/// Begins to write a file: FileWriter::in_place() for a device, a pipe or a descriptor,
/// FileWriter::replace() otherwise. Fails as output_refusal() says, or if it cannot be written; the
/// error begins with the name of the file.
Result<FileWriter, std::string> open_output_file(const std::string& file, mode_t mode = 0666);
/// Writes the file as open_output_file() does. The error begins with the name of the file.
Result<void, std::string> write_output_file(const std::string& file, std::string_view bytes);
/// Makes an empty file, or empties it, so that nobody reads an old value. Does nothing to a device,
/// a pipe or a descriptor. The error begins with the name of the file.
Result<void, std::string> empty_output_file(const std::string& file);

}  // namespace runstone
