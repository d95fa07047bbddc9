// The loggers of the server program, one for each module: world, net, store, app. Lines go to
// stderr. A line that cannot be written there is dropped and counted.
#pragma once
#include <spdlog/spdlog.h>

#include <cstdint>

#include "server/admin/log_format.hpp"
#include "server/admin/log_level.hpp"

namespace runstone {

/// Creates the loggers, or sets level and format of existing ones.
void start_logging(LogLevel level, LogFormat format = LogFormat::text);
/// Returns a module's logger. Requires start_logging().
spdlog::logger& logger(const char* module);
/// Returns the number of lines that were dropped: stderr could not be written, or too many lines
/// waited for its reader.
std::uint64_t dropped_log_lines();

}  // namespace runstone
