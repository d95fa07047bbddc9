// The reader of recorded logs. It waits for the disk, so it is for the start of a program.
#pragma once
#include <string>

#include "client/bots/recorded_log.hpp"

namespace runstone {

/// Reads and verifies the whole .rlog file. Fails with one line of text that names the file and the
/// place in it.
Result<RecordedLog, std::string> read_recorded_file(const std::string& file);

}  // namespace runstone
