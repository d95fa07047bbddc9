// The chunks that `runstone-bench view` shows.
#pragma once
#include <string>
#include <vector>

#include "bench/frames/frames_world.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"

namespace runstone::bench {

/// Returns "hill", a single chunk of the world "hills", the names of the seeded worlds, and those
/// of frames_world_names().
std::vector<std::string> view_world_names();

/// Returns the chunks of that name, at edge 32. Those of a seeded world are 4 x 2 x 4 around its
/// ground. Requires a name of the list. Fails as frames_world() does.
Result<FramesWorld, std::string> view_world(const std::string& name, const std::string& luanti);

/// Returns the materials of a world. If it has none, they have made-up colours for the ids that its
/// chunks contain.
MaterialTable materials_of(const FramesWorld& world);

}  // namespace runstone::bench
