#include <iostream>

#include "bench/app/bench_program.hpp"

int main(int argc, char** argv) {
  return runstone::bench::bench_program(argc, argv, std::cout, std::cerr);
}
