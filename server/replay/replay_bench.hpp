// How fast a world's log is read, and how fast the world is rebuilt from it: `runstone-replay --bench`.
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "server/replay/replay_options.hpp"

namespace runstone {

/// Times both `options.rounds` times, in turns, up to `options.at`, and prints a table; `options.json` gets all times.
/// The error is one line; a replay that differs is one. Memory: all edited chunks as runs.
Result<void, std::string> bench_replay(const ReplayOptions& options, std::ostream& out);

}  // namespace runstone
