// Loggers of the server program, one per module: world, net, store, app. Lines go to stderr.
#pragma once
#include <spdlog/spdlog.h>

#include <memory>
#include <string>

namespace runstone {

/// Makes the loggers, or sets the level of those that are there. `level`: debug, info, warn or error.
void start_logging(const std::string& level);
/// A module's logger; start_logging() must have been called.
spdlog::logger& logger(const char* module);

}  // namespace runstone
