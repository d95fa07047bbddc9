// A recorded log from a file. Blocks on the disk: for start-up.
#pragma once
#include <string>

#include "client/bots/recorded_log.hpp"

namespace runstone {

/// Reads and verifies the whole .rlog. The error is one line that names the file and the place in it.
Result<RecordedLog, std::string> read_recorded_file(const std::string& file);

}  // namespace runstone
