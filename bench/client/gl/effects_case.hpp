// The cost of the client's effects in a frame, with RDM quads and with culled faces.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/client/client_options.hpp"
#include "bench/client/client_result.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

struct EffectsResult {
  std::string gl_renderer, gl_context;
  std::vector<EffectsRow> rows;
};

/// Draws the worlds hills and luanti from a player's height, with every quality. The ways to draw
/// take turns, in an order that is shuffled for each frame. Fails if the Luanti world cannot be
/// read. Throws std::runtime_error if there is no OpenGL.
Result<EffectsResult, std::string> measure_effects(const ClientBenchOptions& options,
                                                   std::ostream& progress);

}  // namespace runstone::bench
