#pragma once

namespace runstone {

/// The least severity of the lines that are logged.
enum class LogLevel { debug, info, warn, error };

}  // namespace runstone
