// A cell: the mesher_cases of one volume, measured in one go by Google Benchmark with their repetitions
// shuffled, so that a noisy machine hits all of them alike. A repetition is a block of calls to warm up, the
// same block timed, and as many plain copies of the bytes that the mesher reads and writes: the limit. Time
// is what the thread has had of its core; phases share it as the monotonic clock saw them. Single-threaded.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/meshing/mesh_figures.hpp"
#include "tests/bench/meshing/mesher_case.hpp"

namespace runstone::bench {

inline constexpr double kBlockNs = 100'000;   // or one call, if that takes longer
inline constexpr double kCellSecondsMax = 5;  // of one mesher_case in one cell

struct Timing {
  double median_ns = 0, min_ns = 0, p90_ns = 0;  // of one mesh, over the repetitions
  std::array<double, kPhaseCount> phase_ns{};  // medians; `mesh` is what the others leave of a call
  double copy_ns = 0;                          // median of a plain copy of its input and output
  std::size_t quads = 0, storage_bytes = 0;
  MeshFigures mesh;
  std::size_t allocations = 0;  // of one warm call
};

/// By mesher_case; none where the cell would have taken longer than kCellSecondsMax. Calls each at least
/// three times. Requires mesher_cases of different names.
std::vector<std::optional<Timing>> measure_cell(std::span<MesherCase> mesher_cases,
                                                unsigned repetitions);

}  // namespace runstone::bench
