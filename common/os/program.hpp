// The frame of a program: what the main function of each program does before and after its work.
#pragma once
#include <functional>

#include "common/core/result.hpp"

namespace runstone {

/// Runs the body of a program, and returns the exit code of the process:
///   - the code that the body returns;
///   - `failed` if an exception leaves the body, whose text is printed to standard error;
///   - `failed` instead of 0 if standard output could not be written completely, with a line about
///     it on standard error.
/// From this call on SIGPIPE and SIGXFSZ are ignored. A write to a pipe that nobody reads then fails
/// with EPIPE, and a write beyond the limit of the size of files with EFBIG. Each of these signals
/// would otherwise end the process. `name`: of the program, for its lines.
int run_program(const char* name, int failed, const std::function<int()>& body);

/// Writes what is queued for standard output. Fails if something could not be written since the
/// last call; the error is one line.
Result<void, std::string> flush_standard_output();

}  // namespace runstone
