// The program runstone-bench without main().
#pragma once
#include <iosfwd>

namespace runstone::bench {

/// Prints tables to `out`, progress and errors to `err`. Returns 0, 1 if something cannot be read
/// or written, or 2 for a bad command line.
int bench_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace runstone::bench
