// The log of the gateway: lines on standard error. Each begins with the name of the program.
// Threads: any.
#pragma once
#include <cstdint>
#include <string_view>

namespace runstone {

/// Writes a line with one call of the system, and blocks while a pipe is full. Appends the end of the
/// line. If the write fails, because a pipe has lost its reader or a disk is full, the line is dropped
/// and counted, and the next line is tried again.
void log_web_line(std::string_view line);

/// Returns the number of lines that were dropped since the start.
std::uint64_t dropped_web_lines();

}  // namespace runstone
