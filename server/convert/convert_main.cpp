#include <iostream>

#include "common/os/program.hpp"
#include "server/convert/convert_program.hpp"

int main(int argc, char** argv) {
  return runstone::run_program("runstone-convert", 1, [&] {
    return runstone::convert_program(argc, argv, std::cout, std::cerr);
  });
}
