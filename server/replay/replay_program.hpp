// runstone-replay as a function, so that tests can run it: arguments in, table and exit code out.
#pragma once
#include <iosfwd>

namespace runstone {

/// What scripts may rely on.
enum class ReplayExit { equal = 0, different = 1, cannot_read = 2 };

/// `out` takes the table (or the help text), `err` one line per error. Progress goes to the terminal, if
/// there is one.
int replay_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace runstone
