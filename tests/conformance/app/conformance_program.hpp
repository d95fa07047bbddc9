// The program runstone-conformance: writes and checks golden vectors, and judges clients.
#pragma once
#include <iosfwd>

namespace runstone::conformance {

/// Runs the program. Returns its exit code: 0 if all is well, 1 if a client or a file failed, 2 if
/// the command line is wrong or something could not be done.
int conformance_program(int argc, char** argv, std::ostream& out, std::ostream& errors);

}  // namespace runstone::conformance
