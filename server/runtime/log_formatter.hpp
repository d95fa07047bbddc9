// The forms of a log line, for spdlog.
//   text  2026-11-23T23:41:07.123 info app: listening port=4747
//   json  {"time":"2026-11-23T23:41:07.123Z","level":"info","logger":"app","message":"..."}
// Times are local in text, with the machine's time zone, and UTC in JSON.
#pragma once
#include <spdlog/formatter.h>

#include <memory>

#include "server/admin/log_format.hpp"

namespace runstone {

std::unique_ptr<spdlog::formatter> make_log_formatter(LogFormat format);

}  // namespace runstone
