#include "bench/meshing/cell.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>

#include "bench/harness/clocks.hpp"
#include "bench/harness/shuffled.hpp"
#include "bench/harness/statistics.hpp"
#include "tests/support/core/count_allocations.hpp"

namespace runstone::bench {
namespace {

/// The figures of a repetition, in this order: ns of a call, ns of a copy, ns of each phase.
enum Figure : std::size_t { kCall, kCopy, kFirstPhase };

/// Returns the thread's processor time for one of `calls` calls of `work`.
template <class Work>
double core_ns_per_call(std::uint64_t calls, Work work) {
  const std::uint64_t start = core_ns();
  for (std::uint64_t i = 0; i < calls; ++i) work();
  return static_cast<double>(core_ns() - start) / static_cast<double>(calls);
}

/// Divides the time of a call among its phases.
void add_phases(PhaseTimes phases, std::uint64_t wall_ns, double call_ns,
                std::vector<double>& figures) {
  std::uint64_t before_mesh = 0;
  for (const std::uint64_t phase : phases) before_mesh += phase;
  phases[static_cast<std::size_t>(Phase::mesh)] = wall_ns - before_mesh;
  for (const std::uint64_t phase : phases) {
    figures.push_back(call_ns * static_cast<double>(phase) / static_cast<double>(wall_ns));
  }
}

std::vector<double> repeat(const MesherCase& mesher_case, std::size_t mesh_bytes,
                           std::uint64_t calls) {
  const std::size_t bytes = mesher_case.storage_bytes + mesh_bytes;
  std::vector<char> from(bytes, 1), to(bytes, 2);
  PhaseTimes phases{};
  for (std::uint64_t i = 0; i < calls; ++i) mesher_case.mesh(phases);
  phases = {};
  const std::uint64_t start = now_ns();
  const double call_ns = core_ns_per_call(calls, [&] { mesher_case.mesh(phases); });
  const std::uint64_t wall_ns = now_ns() - start;
  const double copy_ns = core_ns_per_call(calls, [&] {
    std::memcpy(to.data(), from.data(), bytes);
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  });
  std::vector<double> figures = {call_ns, copy_ns};
  add_phases(phases, wall_ns, call_ns, figures);
  return figures;
}

Timing timing_of(const std::vector<std::vector<double>>& samples) {
  const std::vector<double>& calls = samples[kCall];
  Timing out;
  out.median_ns = median(calls);
  out.min_ns = *std::min_element(calls.begin(), calls.end());
  out.p90_ns = quantile(calls, 0.9);
  out.copy_ns = median(samples[kCopy]);
  for (std::size_t p = 0; p < kPhaseCount; ++p) out.phase_ns[p] = median(samples[kFirstPhase + p]);
  return out;
}

}  // namespace

std::vector<std::optional<Timing>> measure_cell(std::span<MesherCase> mesher_cases,
                                                unsigned repetitions) {
  std::vector<ShuffledCase> cases;
  std::vector<std::optional<Timing>> out(mesher_cases.size());
  reference::Surface surface;
  for (std::size_t i = 0; i < mesher_cases.size(); ++i) {
    const MesherCase& mesher_case = mesher_cases[i];
    PhaseTimes unused{};
    mesher_case.mesh(unused);
    Timing timing;
    // It is the faster of two calls, since another program may use the core during one of them.
    double call_ns = 1e18;
    for (int call = 0; call < 2; ++call) {
      const std::uint64_t start = now_ns();
      timing.allocations = test::allocations_of([&] { mesher_case.mesh(unused); }).count;
      call_ns =
          std::min(call_ns, static_cast<double>(std::max<std::uint64_t>(now_ns() - start, 10)));
    }
    const auto calls = static_cast<std::uint64_t>(std::max(1.0, kBlockNs / call_ns));
    // A repetition calls the block twice and makes copies that cost no more than the block.
    if (repetitions * call_ns * 3 * static_cast<double>(calls) > kCellSecondsMax * 1e9) continue;
    mesher_case.surface(surface);
    timing.quads = mesher_case.quads();
    timing.mesh = figures_of(surface);
    timing.storage_bytes = mesher_case.storage_bytes;
    out[i] = timing;
    cases.push_back(
        {std::string(mesher_case.name), [&mesher_case, bytes = timing.mesh.bytes, calls] {
           return repeat(mesher_case, bytes, calls);
         }});
  }
  const auto samples = run_shuffled(cases, repetitions);
  for (std::size_t i = 0, measured = 0; i < mesher_cases.size(); ++i) {
    if (!out[i]) continue;
    const Timing& known = *out[i];
    Timing timing = timing_of(samples[measured++]);
    timing.quads = known.quads;
    timing.mesh = known.mesh;
    timing.storage_bytes = known.storage_bytes;
    timing.allocations = known.allocations;
    out[i] = timing;
  }
  return out;
}

}  // namespace runstone::bench
