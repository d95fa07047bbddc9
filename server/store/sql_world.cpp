// Opening of a world on any backend, and its conversion to the present format. sql_store.cpp has the
// calls on an open world.
#include <algorithm>
#include <utility>

#include "common/tiles/tile_rules.hpp"
#include "server/store/loss_advice.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

/// Returns the error about a log that ends elsewhere than `meta` says. SQLite may have copied a whole
/// WAL into the main file before a frame of it is damaged. The frames before the damage then hide
/// newer pages of the main file. The page of `meta` is among them, because every commit of edits
/// writes it; the last page of the log may not be.
StoreError mixture(const std::string& file, const std::string& advice, Sequence found,
                   Sequence expected) {
  return {StoreError::Kind::corrupt, file, "edit_log",
          "ends at seq=" + std::to_string(found) +
              ", but meta says seq=" + std::to_string(expected) + ": " + advice};
}

/// Returns the error about a world that was durable up to `durable` and holds `found`.
StoreError loss_of(const std::string& file, const DurableState& found,
                   const DurableState& durable) {
  std::string what = "ends at seq=" + std::to_string(found.seq) + ", but ";
  if (found.seq < durable.seq) {
    what += "seq=" + std::to_string(durable.seq) +
            " was durable: the edits seq=" + std::to_string(found.seq + 1) +
            " to seq=" + std::to_string(durable.seq) + " are lost";
  } else {
    what += "epoch=" + std::to_string(durable.epoch) +
            " was durable: the database has epoch=" + std::to_string(found.epoch) +
            ", so its newest changes are lost";
  }
  what += ", because world.sqlite-wal was lost or damaged, or an older world.sqlite was put back. ";
  return {StoreError::Kind::corrupt, file, "edit_log", what + kLossAdvice};
}

/// Returns the error about a world that a program was writing and that came here in part.
StoreError without_mark(const std::string& file, const std::string& missing, Sequence last) {
  return {StoreError::Kind::corrupt, file, "",
          "is only a part of a world: a server was writing it when it was copied, or did not stop "
          "cleanly, and " +
              missing + (missing.find(" and ") == std::string::npos ? " is" : " are") +
              " missing. The log ends here at seq=" + std::to_string(last) +
              ", and it is not known how many later edits are lost. Put world.sqlite, "
              "world.sqlite-wal and world.durable of one moment together into the folder. " +
              kLossAdvice};
}

}  // namespace

StoreResult<SqlStore::Tables> SqlStore::Tables::open(WorldBackend& backend) {
  sql::Database& database = backend.database();
  auto meta = MetaTable::open(database);
  if (!meta) return failed(meta.error());
  auto players = PlayerTable::open(database);
  if (!players) return failed(players.error());
  auto names = NameTable::open(database);
  if (!names) return failed(names.error());
  const auto version = backend.format();
  if (!version) return failed(version.error());
  std::optional<ClaimTable> claims;
  std::optional<KeptRecords> kept;
  if (*version >= 3) {
    auto claims_opened = ClaimTable::open(database);
    if (!claims_opened) return failed(claims_opened.error());
    claims = *std::move(claims_opened);
    auto kept_opened = KeptRecords::open(database);
    if (!kept_opened) return failed(kept_opened.error());
    kept = *std::move(kept_opened);
  }
  auto log = LogTable::open(database);
  if (!log) return failed(log.error());
  auto segments = SegmentTable::open(database);
  if (!segments) return failed(segments.error());
  auto base = ChunkTable::open(database, ChunkTable::Kind::base);
  if (!base) return failed(base.error());
  auto snapshots = ChunkTable::open(database, ChunkTable::Kind::snapshot);
  if (!snapshots) return failed(snapshots.error());
  auto keyframes = KeyframeTable::open(database);
  if (!keyframes) return failed(keyframes.error());
  std::optional<TileTable> tiles;
  if (*version >= 4) {
    auto tiles_opened = TileTable::open(database);
    if (!tiles_opened) return failed(tiles_opened.error());
    tiles = *std::move(tiles_opened);
  }
  return Tables{*std::move(meta),      *std::move(players), *std::move(names),
                std::move(claims),     std::move(kept),     *std::move(log),
                *std::move(segments),  *std::move(base),    *std::move(snapshots),
                *std::move(keyframes), std::move(tiles)};
}

StoreResult<std::unique_ptr<SqlStore>> SqlStore::open(std::unique_ptr<WorldBackend> backend,
                                                      StoreAccess access) {
  const std::string file = backend->database().file();
  auto tables = Tables::open(*backend);
  if (!tables) return failed(tables.error());
  const auto rows = tables->meta.read_all();
  if (!rows) return failed(rows.error());
  auto meta = meta_of(*rows);
  if (!meta) {
    return failure(StoreError{StoreError::Kind::corrupt, file, "meta key=" + meta.error(),
                              "is missing or has an impossible value"});
  }
  std::unique_ptr<SqlStore> store(
      new SqlStore(std::move(backend), access, *std::move(tables), *std::move(meta)));
  if (const auto read = store->read_state(); !read) return failed(read.error());
  if (store->loss_ && access == StoreAccess::read_write) return failed(*store->loss_);
  if (!store->tiles_ && access != StoreAccess::read_only) {
    if (const auto converted = store->convert(); !converted) return failed(converted.error());
  }
  // A copy of a world is created with format 5. Its row `log_eras` shows that it needs format 6.
  if (rows->contains(kLogErasKey) && access != StoreAccess::read_only && !store->loss_) {
    const auto format = store->backend_->format();
    if (!format) return failed(format.error());
    if (*format < kWorldFormatOfEras) {
      const auto raised = store->transact([&] { return store->raise_format(kWorldFormatOfEras); });
      if (!raised) return failed(raised.error());
    }
  }
  if (rows->contains(kBuildFoldKey)) {
    auto library = BuildTable::open(store->database());
    if (!library) return failed(library.error());
    store->library_ = *std::move(library);
    // A copy is made as a world of the lowest format.
    const auto format = store->backend_->format();
    if (!format) return failed(format.error());
    if (access != StoreAccess::read_only && !store->loss_ && *format < kWorldFormatOfLibrary) {
      const auto raised =
          store->transact([&] { return store->raise_format(kWorldFormatOfLibrary); });
      if (!raised) return failed(raised.error());
    }
  }
  for (const auto& [key, needed] :
       {std::pair(kShapesKey, kWorldFormatOfShapes),
        std::pair(kTexturesKey, kWorldFormatOfTextures), std::pair(kClockKey, kWorldFormatOfClock),
        std::pair(kGapsKey, kWorldFormatOfGaps),
        std::pair(kTimedGrantsKey, kWorldFormatOfTimedGrants)}) {
    if (!rows->contains(key) || access == StoreAccess::read_only || store->loss_) continue;
    const auto format = store->backend_->format();
    if (!format) return failed(format.error());
    if (*format >= needed) continue;
    const auto raised =
        store->transact([&, format_needed = needed] { return store->raise_format(format_needed); });
    if (!raised) return failed(raised.error());
  }
  // A world that lacks edits stays as it is, until its losses are accepted. A reader does not see
  // tiles of other rules.
  if (access != StoreAccess::read_only && !store->loss_) {
    const auto present = store->present_tile_rules(*rows);
    const auto rules = rows->find("tile_rules");
    const bool are_tiles_current =
        present && rules != rows->end() && rules->second == MetaValue{std::int64_t{*present}};
    if (!are_tiles_current) {
      const auto deleted = store->transact([&] { return store->delete_tiles(); });
      if (!deleted) return failed(deleted.error());
    }
  }
  store->backend_->keep_on_close(store->loss_.has_value());
  store->is_whole_ = !store->loss_;
  return store;
}

StoreResult<void> SqlStore::convert() {
  return transact([&]() -> StoreResult<void> {
    if (!claims_) {
      if (auto added = convert_to_format_3(); !added) return added;
    }
    if (auto made = add_tables_of_format_4(database()); !made) return made;
    if (auto marked = raise_format(kWorldFormat); !marked) return marked;
    auto tiles = TileTable::open(database());
    if (!tiles) return failed(tiles.error());
    tiles_ = *std::move(tiles);
    return {};
  });
}

StoreResult<std::uint32_t> SqlStore::present_tile_rules(const MetaRows& rows) {
  if (!rows.contains(kShapesKey)) return kTileRules;
  const auto table = materials(kSequenceMax);
  if (!table) return failed(table.error());
  return tile_rules_of(tile_shapes_number(*table));
}

StoreResult<void> SqlStore::delete_tiles() {
  if (auto cleared = tiles_->clear(); !cleared) return cleared;
  if (auto marked = raise_format(kWorldFormat); !marked) return marked;
  // Damage that keeps the materials from being read must not keep a repair from ending. 0 is the
  // number of no rules: the next opening tries again.
  const auto rows = meta_table_.read_all();
  const auto rules = rows ? present_tile_rules(*rows) : failed(rows.error());
  return meta_table_.put("tile_rules", std::int64_t{rules ? *rules : 0});
}

StoreResult<void> SqlStore::read_state() {
  // The mark is read before the numbers that it is compared with, because a running server raises
  // the numbers first.
  auto marked = backend_->read_mark(meta_.world_id);
  std::optional<Sequence> end;  // every use of a log without an end fails and names the damage
  auto read = at_one_moment<void>([&]() -> StoreResult<void> {
    const auto epoch = meta_table_.counter("epoch");
    if (!epoch) return failed(epoch.error());
    const auto author_max = meta_table_.counter("author_max");
    if (!author_max) return failed(author_max.error());
    const auto log_last = meta_table_.counter("log_last");
    if (!log_last) return failed(log_last.error());
    state_ = {static_cast<Epoch>(*epoch), *log_last, static_cast<AuthorId>(*author_max)};
    const auto open = meta_table_.open_epoch();
    if (!open) return failed(open.error());
    is_open_ = open->has_value();
    const auto range = log_range();
    if (range) {
      end = range->last.version.seq;
    } else if (range.error().may_pass()) {
      return failed(range.error());
    }
    return {};
  });
  if (!read) return read;
  // A server that starts meanwhile makes the mark before it says that it writes.
  if (is_open_ && marked && !*marked) marked = backend_->read_mark(meta_.world_id);
  // A mark that cannot be read now says nothing about a loss.
  if (!marked && marked.error().may_pass()) return failed(marked.error());
  has_mark_file_ = marked && *marked;
  if (end && *end != state_.seq) {
    loss_ = mixture(file(), backend_->mixture_advice(), *end, state_.seq);
    if (access_ != StoreAccess::read_only) return failed(*loss_);
  } else if (!marked) {
    is_mark_unknown_ = true;
    loss_ = marked.error();
    loss_->what += std::string(". ") + kLossAdvice;
  } else if (is_open_ && backend_->has_mark() && !*marked) {
    is_mark_unknown_ = true;
    loss_ = without_mark(file(), backend_->missing_files(), state_.seq);
  } else if (*marked) {
    const DurableState found = state_, durable = **marked;
    state_.epoch = std::max(found.epoch, durable.epoch);
    state_.author_max = std::max(found.author_max, durable.author_max);
    if (found.seq < durable.seq || found.epoch < durable.epoch)
      loss_ = loss_of(file(), found, durable);
  }
  return {};
}

}  // namespace runstone
