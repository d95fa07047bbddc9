// BenchOutput: the output of a run of runstone-bench as a program.
#pragma once
#include <sstream>
#include <string>
#include <vector>

#include "bench/app/bench_program.hpp"

namespace runstone::bench {

struct BenchOutput {
  int exit_code = 0;
  std::string out, err;
};

inline BenchOutput run_bench(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"runstone-bench"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream out, err;
  const int exit_code = bench_program(static_cast<int>(argv.size()), argv.data(), out, err);
  return {exit_code, out.str(), err.str()};
}

}  // namespace runstone::bench
