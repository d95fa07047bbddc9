// The log of a world, played into a live server by runstone-bot, a child process: what joins a server is a client.
#pragma once
#include <string>

#include "common/core/result.hpp"
#include "server/replay/replay_options.hpp"

namespace runstone {

/// Exports the log up to `options.at` to a temporary file, has it played, and takes the file away again, whatever
/// happens; SIGINT and SIGTERM are passed on to the child meanwhile. Returns the child's exit code. The error is one
/// line. Blocks.
Result<int, std::string> play_into(const ReplayOptions& options);

}  // namespace runstone
