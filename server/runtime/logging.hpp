// The loggers of the server program, one for each module: world, net, store, app. Lines go to
// stderr.
#pragma once
#include <spdlog/spdlog.h>

#include <memory>
#include <string>

namespace runstone {

/// Makes the loggers, or sets their level if they exist. `level`: debug, info, warn or error.
void start_logging(const std::string& level);
/// Returns a module's logger. Requires start_logging().
spdlog::logger& logger(const char* module);

}  // namespace runstone
