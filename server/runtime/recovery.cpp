#include "server/runtime/recovery.hpp"

#include <utility>

namespace runstone {
namespace {}  // namespace

Result<WorldStart, std::string> read_world_start(WorldReader& store) {
  WorldStart start;
  const auto range = store.log_range();
  if (!range) return failure(range.error());
  start.log.last = range->last.version.seq;
  start.log.last_time_us = range->last.time_us;
  // Reading the last row verifies its checksum. New edits never get a time before the time of that
  // row, so a damaged time would spread to them.
  const auto last_row =
      store.read_log(start.log.last, start.log.last, [](const EditRecord&) { return true; });
  if (!last_row) return failure(last_row.error());
  const auto checkpoint = store.checkpoint();
  if (!checkpoint) return failure(checkpoint.error());
  start.checkpoint = *checkpoint;
  auto snapshots = store.snapshot_keys();
  if (!snapshots) return failure(snapshots.error());
  start.snapshots = *std::move(snapshots);
  auto players = store.players();
  if (!players) return failure(players.error());
  start.players = *std::move(players);
  start.author_max = store.author_max();
  // A write of a player reads the player's names. A damaged one would end the log writer.
  if (const auto names = store.player_names(); !names) return failure(names.error());
  auto claims = store.name_claims();
  if (!claims) return failure(claims.error());
  start.name_claims = *std::move(claims);
  const auto rights = store.read_rights([&](const EditRecord& record) {
    if (const RightsChange* change = rights_change_of(record.edit))
      start.rights.push_back({*change, {record.version.seq, record.op.author, record.time_us}});
    return true;
  });
  if (!rights) return failure(rights.error());
  auto watermarks = store.high_waters();
  if (!watermarks) return failure(watermarks.error());
  start.resolved = *std::move(watermarks);
  return start;
}

Result<std::uint64_t, std::string> replay_log(LogReader& store, const WorldStart& start,
                                              WorldServer& world) {
  std::uint64_t replayed = 0;
  const auto read =
      store.read_log(start.checkpoint + 1, start.log.last, [&](const EditRecord& record) {
        world.replay_onto_stack(record);
        ++replayed;
        return true;
      });
  if (!read) return failure(read.error());
  return replayed;
}

}  // namespace runstone
