// The thesis' 37 scenarios as it measured them: every one of the 3 x 3 x 3 chunks, with the neighbours it has
// among them, so that a mean over chunks here is the same mean as there.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace runstone::bench {

/// Rows by scenario: number, group (1 .. 3, thesis 8.2), voxels, and means over its chunks of opaque voxels, runs in
/// each axis order ("runs_xyz"), runs in the cheapest order, bytes of run storage here, and as the thesis logs them.
nlohmann::json scenario_facts(std::ostream& progress);

/// Rows by scenario and mesher (those that the thesis has, the product, and the dense baseline): median, mean, least and
/// greatest time over the chunks of a chunk's median, mean share of each phase, mean vertices. `repetitions` of each chunk.
/// One core; a minute or so for each five repetitions.
nlohmann::json scenario_times(unsigned repetitions, std::ostream& progress);

/// General, random or strips: 1 .. 3.
unsigned scenario_group(unsigned number);

}  // namespace runstone::bench
