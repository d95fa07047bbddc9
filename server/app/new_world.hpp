// The rule that keeps a mistyped --world from becoming a new, empty world.
#pragma once
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// Fails if `place` holds no world and the server may not make one there. It may if `create` is
/// set, or if the place is that of the default ServerConfig. The error is one line that names the
/// flag --create.
Result<void, std::string> allow_new_world(const std::string& place, bool create);

}  // namespace runstone
