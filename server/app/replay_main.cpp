#include <iostream>

#include "server/app/replay_program.hpp"

int main(int argc, char** argv) { return runstone::replay_program(argc, argv, std::cout, std::cerr); }
