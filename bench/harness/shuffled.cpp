#include "bench/harness/shuffled.hpp"

#include <benchmark/benchmark.h>

#include "common/core/assert.hpp"

namespace runstone::bench {
namespace {

/// Sets Google Benchmark's flags. It accepts them only as a command line, once in a process.
void shuffle_repetitions() {
  static const bool done = [] {
    char name[] = "runstone-bench", flag[] = "--benchmark_enable_random_interleaving=true";
    char* arguments[] = {name, flag, nullptr};
    int count = 2;
    benchmark::Initialize(&count, arguments);
    return true;
  }();
  static_cast<void>(done);
}

/// Reports nothing: the cases keep their samples.
class Silent final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

}  // namespace

std::vector<std::vector<std::vector<double>>> run_shuffled(std::span<const ShuffledCase> cases,
                                                           unsigned repetitions) {
  std::vector<std::vector<std::vector<double>>> samples(cases.size());
  if (cases.empty()) return samples;
  shuffle_repetitions();
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const auto measure = [&of = samples[c], &each = cases[c]](benchmark::State& state) {
      for (auto _ : state) {
        const std::vector<double> figures = each.repetition();
        of.resize(figures.size());
        for (std::size_t f = 0; f < figures.size(); ++f) of[f].push_back(figures[f]);
        state.SetIterationTime(1e-9);  // Google Benchmark only orders the repetitions
      }
    };
    benchmark::RegisterBenchmark(cases[c].name.c_str(), measure)
        ->Iterations(1)
        ->Repetitions(static_cast<int>(repetitions))
        ->UseManualTime();
  }
  Silent silent;
  benchmark::RunSpecifiedBenchmarks(&silent, ".");
  benchmark::ClearRegisteredBenchmarks();
  for (const auto& of : samples) {
    RUNSTONE_ASSERT(!of.empty() && of[0].size() == repetitions);
  }
  return samples;
}

}  // namespace runstone::bench
