#include <iostream>

#include "server/replay/replay_program.hpp"

int main(int argc, char** argv) {
  return runstone::replay_program(argc, argv, std::cout, std::cerr);
}
