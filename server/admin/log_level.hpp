#pragma once

namespace runstone {

/// Lines below the level are not logged.
enum class LogLevel { debug, info, warn, error };

}  // namespace runstone
