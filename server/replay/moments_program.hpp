// runstone-replay --write and --diff: what can be done with moments of the past.
#pragma once
#include <iosfwd>
#include <string>

#include "server/replay/replay_options.hpp"

namespace runstone {

/// Both print a table to `out` and write options.json if it names a file. The error is one line.
Result<void, std::string> write_moment(const ReplayOptions& options, std::ostream& out);
Result<void, std::string> diff_moments(const ReplayOptions& options, std::ostream& out);

}  // namespace runstone
