// Standby: a server that waits until nobody else writes its world, and takes the world over then.
#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "server/app/server.hpp"

namespace runstone {

/// Starts the server by `start` as soon as nobody writes the world. Goes on waiting if another standby
/// is faster, and while the database does not answer. `stops_within` waits, and returns true if the
/// program has to stop meanwhile. Returns null then. Fails if `start` fails for another reason.
/// Requires start_logging(), and that `place` is a database.
Result<std::unique_ptr<Server>, std::string> start_as_standby(
    const std::string& place, const std::function<bool(std::chrono::milliseconds)>& stops_within,
    const std::function<Result<std::unique_ptr<Server>, std::string>()>& start);

}  // namespace runstone
