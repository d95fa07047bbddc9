// The program runstone-bench, but for main().
#pragma once
#include <iosfwd>

namespace runstone::bench {

/// Tables go to `out`, progress and errors to `err`. Exit code 0; 1 if something could not be read or
/// written; 2 for a bad command line.
int bench_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace runstone::bench
