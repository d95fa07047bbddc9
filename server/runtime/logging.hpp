// The loggers of the server program, one for each module: world, net, store, app. Lines go to
// stderr.
#pragma once
#include <spdlog/spdlog.h>

#include "server/admin/log_format.hpp"
#include "server/admin/log_level.hpp"

namespace runstone {

/// Creates the loggers, or sets level and format of existing ones.
void start_logging(LogLevel level, LogFormat format = LogFormat::text);
/// Returns a module's logger. Requires start_logging().
spdlog::logger& logger(const char* module);

}  // namespace runstone
