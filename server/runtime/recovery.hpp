// Recovery: the state of a world when a server starts. It reads what the store remembers, then
// replays the edits that no snapshot contains.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "server/store/store.hpp"
#include "server/store/world_reader.hpp"
#include "server/world/environment/world_config.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

/// Reads log position, checkpoint, snapshot versions, players and watermarks. Does not set the
/// epoch. Fails if a row cannot be read, or if rows are missing (WorldReader::check_counts()); the
/// error names file, table and row.
Result<WorldStart, std::string> read_world_start(WorldReader& store);

/// Replays the log above the checkpoint onto the edit stacks of `world`. Returns the number of
/// edits. Fails if a record cannot be read; the world must not be used then.
Result<std::uint64_t, std::string> replay_log(LogReader& store, const WorldStart& start,
                                              WorldServer& world);

/// Writes the parts of the log that an earlier owner may not have written, raises the epoch, and
/// reads what a server needs to take the world over. `last`: the last record of this server. Fails
/// if the log has other records than this server; nothing is written then.
Result<Takeover, std::string> prepare_takeover(Store& store, const std::vector<LogPart>& parts,
                                               Version last);
/// Reads what a server that follows has missed: the records from `first` on, `records_max` at most,
/// and all players and names. Cost: O(players + names + records).
Result<ReadLog, std::string> read_missed_log(WorldReader& store, Sequence first,
                                             std::size_t records_max = 8'192);

}  // namespace runstone
