// The thesis' 37 scenarios as the thesis measured them: all 3 x 3 x 3 chunks, each with its
// neighbours among them. So a mean over the chunks is the same mean as in the thesis.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace runstone::bench {

/// Returns a row for each scenario: number, group (1 .. 3, thesis 8.2), voxels, and means over its
/// chunks of opaque voxels, runs in each axis order ("runs_xyz"), runs in the cheapest order, bytes
/// of run storage here, and bytes as the thesis logs them.
nlohmann::json scenario_facts(std::ostream& progress);

/// Returns a row for each scenario and mesher (the thesis' meshers, the product, and the dense
/// baseline): median, mean, least and greatest time over the chunks of a chunk's median, mean share
/// of each phase, mean vertices. Measures each chunk `repetitions` times. Cost: one core, about a
/// minute for each five repetitions.
nlohmann::json scenario_times(unsigned repetitions, std::ostream& progress);

/// Returns the group: 1 general, 2 random, 3 strips.
unsigned scenario_group(unsigned number);

}  // namespace runstone::bench
