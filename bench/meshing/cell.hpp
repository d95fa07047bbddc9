// A cell: the mesher cases of one volume, measured together by Google Benchmark in shuffled
// repetitions, so that noise of the machine affects all of them alike. A repetition has three
// parts:
// - a block of calls to warm up;
// - the same block, timed;
// - as many plain copies of the bytes that the mesher reads and writes, as the lower limit of the
//   time.
// The time is the thread's processor time. It is divided among the phases in the proportions that
// the monotonic clock shows. Single-threaded.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/meshing/mesh_figures.hpp"
#include "bench/meshing/mesher_case.hpp"

namespace runstone::bench {

inline constexpr double kBlockNs = 100'000;   // or one call, if it takes longer
inline constexpr double kCellSecondsMax = 5;  // of one mesher case in one cell

struct Timing {
  double median_ns = 0, min_ns = 0, p90_ns = 0;  // of one mesh, over the repetitions
  std::array<double, kPhaseCount> phase_ns{};    // medians; `mesh` is the rest of a call
  double copy_ns = 0;                            // median of a plain copy of its input and output
  std::size_t quads = 0, storage_bytes = 0;
  MeshFigures mesh;
  std::size_t allocations = 0;  // of one warm call
};

/// Returns the timing of each mesher case, or nullopt where the cell would take longer than
/// kCellSecondsMax. Calls each case at least three times. Requires different names.
std::vector<std::optional<Timing>> measure_cell(std::span<MesherCase> mesher_cases,
                                                unsigned repetitions);

}  // namespace runstone::bench
