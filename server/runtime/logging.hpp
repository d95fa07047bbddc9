// Loggers of the server program, one per module: world, net, store, app. Lines go to stderr.
#pragma once
#include <spdlog/spdlog.h>

#include "server/admin/log_level.hpp"

namespace runstone {

/// Creates the loggers, or sets the level of existing ones.
void start_logging(LogLevel level);
/// A module's logger; start_logging() must have been called.
spdlog::logger& logger(const char* module);

}  // namespace runstone
