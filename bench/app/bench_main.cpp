#include <iostream>

#include "bench/app/bench_program.hpp"
#include "common/os/program.hpp"

int main(int argc, char** argv) {
  return runstone::run_program("runstone-bench", 1, [&] {
    return runstone::bench::bench_program(argc, argv, std::cout, std::cerr);
  });
}
