// Machine: what a figure was measured on and with.
#pragma once
#include <iosfwd>
#include <string>

namespace runstone::bench {

struct Machine {
  std::string cpu;  // as the system names it
  unsigned cores = 0;
  std::string compiler;
  std::string
      commit;        // of the sources the program was built from; "-dirty" if they differed from it
  std::string simd;  // vector instructions that Highway picks here
};

Machine this_machine();

/// One line.
void write_machine(const Machine& machine, std::ostream& out);

}  // namespace runstone::bench
