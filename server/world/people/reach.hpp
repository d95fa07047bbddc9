// Reach: how far from a player an edit may be.
#pragma once
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "server/world/environment/clocks.hpp"
#include "server/world/environment/world_config.hpp"
#include "server/world/sessions/session.hpp"

namespace runstone {

/// Returns true if the edit lies within WorldConfig::reach_max of the place that the session's
/// player can have reached by now.
bool is_within_reach(const WorldConfig& config, Session& session, const EditDescriptor& edit,
                     const Clocks& now);

}  // namespace runstone
