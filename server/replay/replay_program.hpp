// runstone-replay as a function, so that tests can run it.
#pragma once
#include <iosfwd>

namespace runstone {

/// Runs the subcommand that the arguments name. Returns the exit code (ReplayExit; `play` returns
/// that of runstone-bot). Prints the table or the help text to `out` and errors, one line each, to
/// `err`. Prints progress to standard error.
int replay_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace runstone
