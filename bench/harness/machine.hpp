// Machine: the hardware, compiler and commit behind a figure.
#pragma once
#include <iosfwd>
#include <string>

namespace runstone::bench {

struct Machine {
  std::string cpu;  // as the system names it
  unsigned cores = 0;
  std::string compiler;
  std::string commit;  // of the sources of the program; ends with "-dirty" if they differed from it
  std::string simd;    // the vector instructions that Highway selects here
};

Machine this_machine();

/// Prints one line.
void write_machine(const Machine& machine, std::ostream& out);

}  // namespace runstone::bench
