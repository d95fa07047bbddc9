// Recovery: the state of a world when a server starts. It reads what the store remembers, then
// replays the edits that no snapshot contains.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/result.hpp"
#include "server/store/world_reader.hpp"
#include "server/world/world_config.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

/// Reads log position, checkpoint, snapshot versions, players and watermarks. Does not set the
/// epoch. Fails if a row cannot be read, or if players or watermarks are missing; the error names
/// file, table and row.
Result<WorldStart, std::string> read_world_start(WorldReader& store);

/// Replays the log above the checkpoint onto the edit stacks of `world`. Returns the number of
/// edits. Fails if a record cannot be read; the world must not be used then.
Result<std::uint64_t, std::string> replay_log(LogReader& store, const WorldStart& start,
                                              WorldServer& world);

}  // namespace runstone
