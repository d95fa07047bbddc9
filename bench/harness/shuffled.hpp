// Shuffled repetitions: Google Benchmark runs the repetitions of several cases in random order, so
// that noise of the machine affects all of them alike.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace runstone::bench {

struct ShuffledCase {
  std::string name;
  /// Runs one repetition and returns what it measured: the same number of figures each time.
  std::function<std::vector<double>()> repetition;
};

/// Runs all cases. Returns samples[case][figure], in the order of the repetitions. Requires
/// different names of cases, and repetitions > 0.
std::vector<std::vector<std::vector<double>>> run_shuffled(std::span<const ShuffledCase> cases,
                                                           unsigned repetitions);

}  // namespace runstone::bench
