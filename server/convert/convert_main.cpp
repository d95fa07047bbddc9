#include <iostream>

#include "server/convert/convert_program.hpp"

int main(int argc, char** argv) {
  return runstone::convert_program(argc, argv, std::cout, std::cerr);
}
