// Shuffled repetitions: cases measured in one go by Google Benchmark, each so many times, all in random turns, so
// that a noisy machine hits all of them alike.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace runstone::bench {

struct ShuffledCase {
  std::string name;
  /// One repetition: what it measured, always as many figures.
  std::function<std::vector<double>()> repetition;
};

/// samples[case][figure]: what the repetitions measured. Requires cases of different names, and repetitions > 0.
std::vector<std::vector<std::vector<double>>> run_shuffled(std::span<const ShuffledCase> cases,
                                                           unsigned repetitions);

}  // namespace runstone::bench
