// Mesher cases that mesh a dense grid which is ready before the time starts.
#pragma once
#include <string_view>

#include "bench/meshing/mesher_case.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone::bench {

/// Returns the case simple, greedy, naive_greedy, run_strips, run_strips_hidden, optimal_greedy,
/// monotone, poly2tri or grid_rdm (mesher_case.hpp), still without its name. `visibility` must
/// outlive it. Aborts on another name.
MesherCase grid_mesher_case(std::string_view name, const Volume& volume,
                            const VisibilityTable& visibility);

}  // namespace runstone::bench
