#include "tests/bench/cell.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "tests/bench/statistics.hpp"
#include "tests/support/count_allocations.hpp"

namespace runstone::bench {
namespace {

/// Samples of one contestant, a value a repetition.
struct Samples {
  std::vector<double> call_ns, copy_ns;
  std::array<std::vector<double>, kPhaseCount> phase_ns;
};

/// What Google Benchmark hands over: the time of each repetition, and our counters with it.
class Collector final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      Samples& to = samples_[run.run_name.function_name];
      to.call_ns.push_back(run.GetAdjustedRealTime());
      to.copy_ns.push_back(run.counters.at("copy"));
      for (std::size_t p = 0; p < kPhaseCount; ++p) {
        to.phase_ns[p].push_back(run.counters.at(std::string(kPhaseNames[p])));
      }
    }
  }
  const Samples& of(std::string_view contestant) const { return samples_.find(contestant)->second; }

 private:
  std::map<std::string, Samples, std::less<>> samples_;
};

/// What this thread needs of its core for each of `calls` calls of `work`.
template <class Work>
double core_ns_per_call(std::uint64_t calls, Work work) {
  const std::uint64_t start = core_ns();
  for (std::uint64_t i = 0; i < calls; ++i) work();
  return static_cast<double>(core_ns() - start) / static_cast<double>(calls);
}

/// Shares the time of a call out among its phases.
void count_phases(benchmark::State& state, PhaseTimes phases, std::uint64_t wall_ns, double call_ns) {
  std::uint64_t before_mesh = 0;
  for (const std::uint64_t phase : phases) before_mesh += phase;
  phases[static_cast<std::size_t>(Phase::mesh)] = wall_ns - before_mesh;
  for (std::size_t p = 0; p < kPhaseCount; ++p) {
    state.counters[std::string(kPhaseNames[p])] =
        call_ns * static_cast<double>(phases[p]) / static_cast<double>(wall_ns);
  }
}

void repeat(benchmark::State& state, const Contestant& contestant, std::size_t mesh_bytes,
            std::uint64_t calls) {
  const std::size_t bytes = contestant.storage_bytes + mesh_bytes;
  std::vector<char> from(bytes, 1), to(bytes, 2);
  for (auto _ : state) {
    PhaseTimes phases{};
    for (std::uint64_t i = 0; i < calls; ++i) contestant.mesh(phases);
    phases = {};
    const std::uint64_t start = now_ns();
    const double call_ns = core_ns_per_call(calls, [&] { contestant.mesh(phases); });
    count_phases(state, phases, now_ns() - start, call_ns);
    state.SetIterationTime(call_ns * 1e-9);
    state.counters["copy"] = core_ns_per_call(calls, [&] {
      std::memcpy(to.data(), from.data(), bytes);
      benchmark::DoNotOptimize(to.data());
      benchmark::ClobberMemory();
    });
  }
}

/// Google Benchmark takes its flags from a command line, once in a process.
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

Timing timing_of(const Samples& samples) {
  Timing out;
  out.median_ns = median(samples.call_ns);
  out.min_ns = *std::min_element(samples.call_ns.begin(), samples.call_ns.end());
  out.p90_ns = quantile(samples.call_ns, 0.9);
  out.copy_ns = median(samples.copy_ns);
  for (std::size_t p = 0; p < kPhaseCount; ++p) out.phase_ns[p] = median(samples.phase_ns[p]);
  return out;
}

}  // namespace

std::vector<std::optional<Timing>> measure_cell(std::span<Contestant> contestants, unsigned repetitions) {
  shuffle_repetitions();
  std::vector<std::optional<Timing>> out(contestants.size());
  reference::Surface surface;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    const Contestant& contestant = contestants[i];
    PhaseTimes unused{};
    contestant.mesh(unused);
    Timing timing;
    double call_ns = 1e18;  // the faster of two calls: others may have the core during one
    for (int call = 0; call < 2; ++call) {
      const std::uint64_t start = now_ns();
      timing.allocations = test::allocations_of([&] { contestant.mesh(unused); }).count;
      call_ns = std::min(call_ns, static_cast<double>(std::max<std::uint64_t>(now_ns() - start, 10)));
    }
    const auto calls = static_cast<std::uint64_t>(std::max(1.0, kBlockNs / call_ns));
    // A repetition: the block twice, and copies that cost no more than the block.
    if (repetitions * call_ns * 3 * static_cast<double>(calls) > kCellSecondsMax * 1e9) continue;
    contestant.surface(surface);
    timing.quads = contestant.quads();
    timing.mesh = figures_of(surface);
    timing.storage_bytes = contestant.storage_bytes;
    out[i] = timing;
    benchmark::RegisterBenchmark(std::string(contestant.name).c_str(),
                                 [&contestant, bytes = timing.mesh.bytes, calls](benchmark::State& s) {
                                   repeat(s, contestant, bytes, calls);
                                 })
        ->Iterations(1)
        ->Repetitions(static_cast<int>(repetitions))
        ->UseManualTime()
        ->Unit(benchmark::kNanosecond);
  }
  if (std::none_of(out.begin(), out.end(), [](const auto& timing) { return timing.has_value(); })) return out;
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector, ".");
  benchmark::ClearRegisteredBenchmarks();
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    if (!out[i]) continue;
    const Timing& known = *out[i];
    Timing timing = timing_of(collector.of(contestants[i].name));
    timing.quads = known.quads;
    timing.mesh = known.mesh;
    timing.storage_bytes = known.storage_bytes;
    timing.allocations = known.allocations;
    out[i] = timing;
  }
  return out;
}

}  // namespace runstone::bench
