// runstone-replay --keyframes: makes the keyframes that a world lacks, while no server runs it.
#pragma once
#include <iosfwd>
#include <string>

#include "server/replay/replay_options.hpp"

namespace runstone {

/// Prints what it did and writes options.json if it names a file; the error is one line. What was made before an error stays.
Result<void, std::string> make_keyframes(const ReplayOptions& options, std::ostream& out);

}  // namespace runstone
