#include <iostream>

#include "common/os/program.hpp"
#include "tests/conformance/app/conformance_program.hpp"

int main(int argc, char** argv) {
  return runstone::run_program("runstone-conformance", 2, [&] {
    return runstone::conformance::conformance_program(argc, argv, std::cout, std::cerr);
  });
}
