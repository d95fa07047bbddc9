#include "server/runtime/recovery.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "server/runtime/logging.hpp"
#include "server/textures/stored_textures.hpp"

namespace runstone {
namespace {

constexpr const char* kStartAgain = "start it again";

/// Fails if what a server that follows has and the log do not continue each other. `parts`: its records
/// that may not be in the log. `last`: its last record. `end`: of the log.
Result<void, std::string> is_prefix(Store& store, const std::vector<LogPart>& parts, Version last,
                                    Sequence end) {
  // An owner wrote all records that it had before it raised the epoch. What the log lacks of earlier
  // epochs, that owner did not have.
  if (last.seq > end && last.epoch < store.epoch())
    return failure("another server has owned the world since, without all edits of this one: " +
                   std::string(kStartAgain));
  Version common = last;
  for (const LogPart& part : parts) {
    for (const LogPartRecord& mine : part.records) {
      if (mine.record.version.seq == end) common = mine.record.version;
    }
  }
  // Records before those of `parts` are durable, and durable ones do not change.
  if (common.seq == 0 || common.seq > end) return {};
  const auto there = store.edit_at(common.seq);
  if (!there) return failure(there.error().message());
  if (*there && (*there)->version == common) return {};
  return failure("the log has other edits than this server: " + std::string(kStartAgain));
}

/// Writes what the log lacks of a part. `end`: the end of the log when the first part was written.
StoreResult<void> write_rest(Store& store, const LogPart& part, Sequence end) {
  std::vector<NameChange> names;
  for (const LogName& name : part.names)
    names.push_back({{name.folded, name.name, name.key}, name.is_release});
  if (!names.empty()) {
    // Another key may own the name by now: what is in the database is newer then.
    const auto written = store.change_names(names);
    if (!written && written.error().kind != StoreError::Kind::bad_request) return written;
  }
  std::vector<PlayerRow> players;
  for (const LogPlayer& row : part.players) players.push_back({row.author, row.key, row.name});
  std::vector<EditRecord> records;
  for (const LogPartRecord& mine : part.records) {
    if (mine.record.version.seq > end) records.push_back(mine.record);
  }
  if (players.empty() && records.empty()) return {};
  return store.append_history(players, records);
}

/// Returns a part of the state that is kept besides the log. If it is damaged, logs a warning and
/// returns an empty one, because no edit depends on it.
template <typename Part>
StoreResult<Part> part_or_none(StoreResult<Part> part, const char* lost) {
  if (part || part.error().kind != StoreError::Kind::corrupt) return part;
  logger("store").warn("{}: {}", part.error().message(), lost);
  return Part{};
}

StoreResult<std::vector<LastPlace>> places_or_none(WorldReader& store) {
  return part_or_none(store.saved_places(), "the places of the players are lost");
}

}  // namespace

Result<WorldStart, std::string> read_world_start(WorldReader& store) {
  WorldStart start;
  const auto range = store.log_range();
  if (!range) return failure(range.error().message());
  start.log.last = range->last.version.seq;
  start.log.last_epoch = range->last.version.epoch;
  start.log.last_time_us = range->last.time_us;
  // Reading the last row verifies its checksum. New edits never get a time before the time of that
  // row, so a damaged time would spread to them.
  const auto last_row =
      store.read_log(start.log.last, start.log.last, [](const EditRecord&) { return true; });
  if (!last_row) return failure(last_row.error().message());
  const auto checkpoint = store.checkpoint();
  if (!checkpoint) return failure(checkpoint.error().message());
  start.checkpoint = *checkpoint;
  auto snapshots = store.snapshot_keys();
  if (!snapshots) return failure(snapshots.error().message());
  start.snapshots = *std::move(snapshots);
  auto players = store.players();
  if (!players) return failure(players.error().message());
  start.players = *std::move(players);
  start.author_max = store.author_max();
  // A write of a player reads the player's names. A damaged one would end the log writer.
  if (const auto names = store.player_names(); !names) return failure(names.error().message());
  auto claims = store.name_claims();
  if (!claims) return failure(claims.error().message());
  start.name_claims = *std::move(claims);
  const auto rights = store.read_rights([&](const EditRecord& record) {
    if (const RightsChange* change = rights_change_of(record.edit))
      start.rights.push_back({*change, {record.version.seq, record.op.author, record.time_us}});
    return true;
  });
  if (!rights) return failure(rights.error().message());
  auto watermarks = store.high_waters();
  if (!watermarks) return failure(watermarks.error().message());
  start.resolved = *std::move(watermarks);
  auto library = store.library_rows();
  if (!library) return failure(library.error().message());
  start.library = *std::move(library);
  auto textures = read_stored_textures(store);
  if (!textures) return failure(textures.error());
  start.textures = std::move(textures->given);
  auto places = places_or_none(store);
  if (!places) return failure(places.error().message());
  start.saved.places = *std::move(places);
  const auto clock = part_or_none(store.saved_clock(), "the time of the world is lost");
  if (!clock) return failure(clock.error().message());
  start.saved.clock = *clock;
  if (const auto counted = store.check_counts(); !counted)
    return failure(counted.error().message());
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
  if (!read) return failure(read.error().message());
  return replayed;
}

Result<Takeover, std::string> prepare_takeover(Store& store, const std::vector<LogPart>& parts,
                                               Version last) {
  const auto end = store.last_sequence();
  if (!end) return failure(end.error().message());
  if (const auto same = is_prefix(store, parts, last, *end); !same) return failure(same.error());
  for (const LogPart& part : parts) {
    if (const auto written = write_rest(store, part, *end); !written)
      return failure(written.error().message());
  }
  Takeover out;
  const auto epoch = store.raise_epoch();
  if (!epoch) return failure(epoch.error().message());
  out.epoch = *epoch;
  const auto checkpoint = store.checkpoint();
  if (!checkpoint) return failure(checkpoint.error().message());
  out.checkpoint = *checkpoint;
  out.author_max = store.author_max();
  auto read = read_missed_log(store, std::max<Sequence>(1, last.seq), SIZE_MAX);
  if (!read) return failure(read.error());
  out.read = *std::move(read);
  auto places = places_or_none(store);
  if (!places) return failure(places.error().message());
  out.places = *std::move(places);
  return out;
}

Result<ReadLog, std::string> read_missed_log(WorldReader& store, Sequence first,
                                             std::size_t records_max) {
  ReadLog read;
  // The rows of players come before the records that name them, so they are read later.
  const auto range = store.log_range();
  if (!range) return failure(range.error().message());
  read.last = range->last.version.seq;
  const auto done = store.read_log(first, read.last, [&](const EditRecord& record) {
    read.records.push_back(record);
    return read.records.size() < records_max;
  });
  if (!done) return failure(done.error().message());
  auto players = store.players();
  if (!players) return failure(players.error().message());
  read.players = *std::move(players);
  auto claims = store.name_claims();
  if (!claims) return failure(claims.error().message());
  read.names = *std::move(claims);
  return read;
}

}  // namespace runstone
