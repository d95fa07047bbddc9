// Creation and opening of a world: files, lock, marks and pragmas. sqlite_store.cpp has the calls
// on an open world.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/sqlite/transaction.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/store/loss_advice.hpp"
#include "server/store/sqlite_result.hpp"
#include "server/store/sqlite_store.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

std::string file_in(const std::string& folder) { return folder + "/world.sqlite"; }

Unexpected<StoreError> store_failure(StoreError::Kind kind, const std::string& file,
                                     std::string what) {
  return {{kind, file, "", std::move(what)}};
}

/// Takes FOLDER/world.lock, so that at most one process writes the world. `file` names the world in
/// the error.
StoreResult<FileLock> take_lock(const std::string& folder, const std::string& file) {
  const std::string path = folder + "/world.lock";
  auto lock = FileLock::take(path);
  if (lock) return *std::move(lock);
  if (lock.error().is_held)
    return store_failure(StoreError::Kind::locked, file,
                         "another program is writing this world (it holds world.lock)");
  return store_failure(StoreError::Kind::io, path, "cannot be written: " + lock.error().what);
}

/// Only the owner may read the file, because it holds the world's secret key. SQLite gives WAL and
/// shared memory the mode of the file.
constexpr mode_t kFileMode = 0600;
constexpr mode_t kFolderMode = 0700;

/// Makes an empty file for its owner only. SQLite would make one that everybody can read.
StoreResult<void> make_file(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kFileMode);
  if (descriptor < 0) {
    return store_failure(StoreError::Kind::io, file,
                         "cannot be made: " + std::generic_category().message(errno));
  }
  ::close(descriptor);
  return {};
}

/// Makes the folder for its owner only, unless it exists. Its name in the parent folder is on disk
/// on return, before any file in it is reported as durable.
StoreResult<void> make_folder(const std::string& folder, const std::string& file) {
  std::error_code error;
  auto whole = std::filesystem::absolute(folder, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // "valley/"
  std::filesystem::create_directories(whole.parent_path(), error);
  if (!error && ::mkdir(whole.c_str(), kFolderMode) != 0 &&
      !(errno == EEXIST && std::filesystem::is_directory(whole))) {
    error = std::error_code(errno, std::generic_category());
  }
  if (error)
    return store_failure(StoreError::Kind::io, file,
                         "the folder cannot be made: " + error.message());
  const auto parent = whole / "..";
  const int descriptor = ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    ::fsync(descriptor);  // best effort: some file systems cannot sync a folder
    ::close(descriptor);
  }
  return {};
}

// A commit of some edits writes a few pages, each of which it changes in some bytes: one of the log,
// one of the author index for each player, some of the index by place. With pages of 4 KiB it writes
// a quarter more. With pages of 1 KiB it writes little less, and chunks need more overflow pages.
constexpr int kPageBytes = 2'048;
// Pages of the WAL that start a checkpoint: 4 MiB of a world that was made with these pages.
constexpr int kCheckpointPages = 2'048;

/// For WAL, EXTRA is the same as FULL. During creation it also syncs the folder after the rollback
/// journal is deleted. The journal then cannot reappear after a crash and undo a world that is
/// already in use.
const char* sync_pragma(bool sync) {
  return sync ? "PRAGMA synchronous = EXTRA" : "PRAGMA synchronous = OFF";
}

StoreResult<void> set_pragmas(sql::Database& database, StoreAccess access, bool sync) {
  if (access == StoreAccess::read_only)
    return store_result(database.run("PRAGMA query_only = ON; PRAGMA trusted_schema = OFF;"));
  if (auto set = database.run(sync_pragma(sync)); !set) return failed(set.error());
  const auto mode = database.text("PRAGMA journal_mode = WAL");
  if (!mode) return failed(mode.error());
  if (*mode != "wal")
    return store_failure(StoreError::Kind::io, database.file(),
                         "the file system has no shared memory for WAL");
  // Freed pages need not be overwritten with zeros, because the rows of the log hold no secret.
  const std::string set =
      "PRAGMA secure_delete = OFF; PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; "
      "PRAGMA wal_autocheckpoint = " +
      std::to_string(kCheckpointPages);
  return store_result(database.run(set.c_str()));
}

StoreResult<void> write_new_world(sql::Database& database, const WorldMeta& meta, bool sync) {
  // The schema is committed in rollback mode, and WAL is switched on afterwards. Marks and tables
  // are then in the main file itself, where check_marks() reads them. A crash before the commit
  // leaves a file without them.
  const std::string pages = "PRAGMA page_size = " + std::to_string(kPageBytes);
  for (const char* set : {pages.c_str(), "PRAGMA journal_mode = DELETE"}) {
    if (auto done = database.run(set); !done) return failed(done.error());
  }
  if (auto set = database.run(sync_pragma(sync)); !set) return failed(set.error());
  auto transaction = sql::Transaction::begin(database);
  if (!transaction) return failed(transaction.error());
  if (auto made = create_schema(database); !made) return made;
  auto table = MetaTable::open(database);
  if (!table) return failed(table.error());
  MetaRows rows = rows_of(meta);
  rows["epoch"] = std::int64_t{0};
  rows["checkpoint"] = std::int64_t{0};
  rows["author_max"] = std::int64_t{0};
  rows["log_last"] = std::int64_t{0};
  rows["tile_rules"] = std::int64_t{kTileRules};
  for (const auto& [key, value] : rows) {
    if (auto put = table->put(key, value); !put) return put;
  }
  for (const char* key : {"base_fold", "snapshot_fold", "player_fold", "player_instance_fold",
                          "name_claim_fold", "rights_record_fold"}) {
    if (auto put = table->put_fold(key, {}); !put) return put;
  }
  if (auto put = table->put_log_head({}); !put) return put;
  return store_result(transaction->commit());
}

/// Returns the error about a log that ends elsewhere than `meta` says. SQLite may have copied a whole
/// WAL into the main file before a frame of it is damaged. The frames before the damage then hide
/// newer pages of the main file. The page of `meta` is among them, because every commit of edits
/// writes it; the last page of the log may not be.
StoreError mixture(const std::string& file, Sequence found, Sequence expected) {
  return {StoreError::Kind::corrupt, file, "edit_log",
          "ends at seq=" + std::to_string(found) +
              ", but meta says seq=" + std::to_string(expected) +
              ": world.sqlite-wal is damaged and hides newer pages of world.sqlite, or another "
              "program changed the log. Put the world's folder back from a backup"};
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

}  // namespace

StoreResult<SqliteStore::Tables> SqliteStore::Tables::open(sql::Database& database) {
  auto meta = MetaTable::open(database);
  if (!meta) return failed(meta.error());
  auto players = PlayerTable::open(database);
  if (!players) return failed(players.error());
  auto names = NameTable::open(database);
  if (!names) return failed(names.error());
  const auto version = database.integer("PRAGMA user_version");
  if (!version) return failed(version.error());
  std::optional<ClaimTable> claims;
  std::optional<RightsTable> rights;
  if (*version >= 3) {
    auto claims_opened = ClaimTable::open(database);
    if (!claims_opened) return failed(claims_opened.error());
    claims = *std::move(claims_opened);
    auto rights_opened = RightsTable::open(database);
    if (!rights_opened) return failed(rights_opened.error());
    rights = *std::move(rights_opened);
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
                std::move(claims),     std::move(rights),   *std::move(log),
                *std::move(segments),  *std::move(base),    *std::move(snapshots),
                *std::move(keyframes), std::move(tiles)};
}

StoreResult<std::unique_ptr<SqliteStore>> SqliteStore::open(const std::string& folder,
                                                            StoreAccess access,
                                                            const SqliteOptions& options,
                                                            FileLock lock) {
  const std::string file = file_in(folder);
  const auto mode =
      access == StoreAccess::read_only ? sql::Database::Mode::read : sql::Database::Mode::write;
  auto opened = sql::Database::open(file, mode, options.vfs);
  if (!opened) return failed(opened.error());
  auto database = std::make_unique<sql::Database>(*std::move(opened));
  // A world with a loss is left as it is: closing the database would delete what is left of the WAL.
  database->keep_wal_on_close(true);
  if (const auto set = set_pragmas(*database, access, options.sync); !set)
    return failed(set.error());
  // check_marks() may have read the marks of an interrupted creation, which opening the database
  // has rolled back.
  const auto id = database->integer("PRAGMA application_id");
  if (!id) return failed(id.error());
  if (*id != std::int64_t{kApplicationId}) {
    return store_failure(StoreError::Kind::not_a_world, file,
                         "its creation was interrupted; delete it and create the world again");
  }
  auto tables = Tables::open(*database);
  if (!tables) return failed(tables.error());

  const auto rows = tables->meta.read_all();
  if (!rows) return failed(rows.error());
  auto meta = meta_of(*rows);
  if (!meta) {
    return Unexpected<StoreError>{{StoreError::Kind::corrupt, file, "meta key=" + meta.error(),
                                   "is missing or has an impossible value"}};
  }
  auto mark = std::make_unique<DurableMark>(folder, meta->world_id, options.vfs);
  std::unique_ptr<SqliteStore> store(new SqliteStore(std::move(database), std::move(lock), access,
                                                     *std::move(tables), *std::move(meta),
                                                     std::move(mark)));
  if (const auto read = store->read_state(); !read) return failed(read.error());
  if (store->loss_ && access == StoreAccess::read_write) return failed(*store->loss_);
  if (!store->tiles_ && access != StoreAccess::read_only) {
    if (const auto converted = store->convert(); !converted) return failed(converted.error());
  }
  const auto rules = rows->find("tile_rules");
  const bool are_tiles_current =
      rules != rows->end() && rules->second == MetaValue{std::int64_t{kTileRules}};
  // A world that lacks edits stays as it is, until its losses are accepted.
  if (!are_tiles_current && !store->loss_) {
    if (const auto left = store->leave_tiles_of_other_rules(); !left) return failed(left.error());
  }
  store->database_->keep_wal_on_close(store->loss_.has_value());
  return store;
}

StoreResult<void> SqliteStore::convert() {
  return write([&]() -> StoreResult<void> {
    if (!claims_) {
      if (auto added = convert_to_format_3(); !added) return added;
    }
    if (auto made = add_tables_of_format_4(*database_); !made) return made;
    if (auto marked = set_format(*database_); !marked) return marked;
    auto tiles = TileTable::open(*database_);
    if (!tiles) return failed(tiles.error());
    tiles_ = *std::move(tiles);
    return {};
  });
}

StoreResult<void> SqliteStore::leave_tiles_of_other_rules() {
  if (access_ == StoreAccess::read_only) {
    tiles_.reset();
    return {};
  }
  return write([&] { return delete_tiles(); });
}

StoreResult<void> SqliteStore::delete_tiles() {
  if (auto cleared = tiles_->clear(); !cleared) return cleared;
  if (auto marked = set_format(*database_); !marked) return marked;
  return meta_table_.put("tile_rules", std::int64_t{kTileRules});
}

StoreResult<void> SqliteStore::read_state() {
  // The mark is read before the numbers that it is compared with, because a running server raises
  // the numbers first.
  const auto marked = mark_->read();
  std::optional<Sequence> end;  // every use of a log without an end fails and names the damage
  auto read = at_one_moment<void>([&]() -> StoreResult<void> {
    const auto epoch = meta_table_.counter("epoch");
    if (!epoch) return failed(epoch.error());
    const auto author_max = meta_table_.counter("author_max");
    if (!author_max) return failed(author_max.error());
    const auto log_last = meta_table_.counter("log_last");
    if (!log_last) return failed(log_last.error());
    state_ = {static_cast<Epoch>(*epoch), *log_last, static_cast<AuthorId>(*author_max)};
    if (const auto range = log_range()) end = range->last.version.seq;
    return {};
  });
  if (!read) return read;
  if (end && *end != state_.seq) {
    loss_ = mixture(file(), *end, state_.seq);
    if (access_ != StoreAccess::read_only) return failed(*loss_);
  } else if (!marked) {
    is_mark_damaged_ = true;
    loss_ = marked.error();
    loss_->what += std::string(". ") + kLossAdvice;
  } else if (*marked) {
    const DurableState found = state_, durable = **marked;
    state_.epoch = std::max(found.epoch, durable.epoch);
    state_.author_max = std::max(found.author_max, durable.author_max);
    if (found.seq < durable.seq || found.epoch < durable.epoch)
      loss_ = loss_of(file(), found, durable);
  }
  return {};
}

StoreResult<std::unique_ptr<Store>> create_sqlite_world(const std::string& folder,
                                                        const WorldMeta& meta,
                                                        const SqliteOptions& options) {
  const std::string file = file_in(folder);
  if (auto readable = meta_of(rows_of(meta)); !readable) {
    return store_failure(StoreError::Kind::bad_request, file,
                         "a new world cannot have this " + readable.error());
  }
  if (const auto made = make_folder(folder, file); !made) return failed(made.error());
  auto lock = take_lock(folder, file);
  if (!lock) return failed(lock.error());
  const auto there = sql::file_exists(file, options.vfs);
  if (!there) return failed(there.error());
  if (*there) return store_failure(StoreError::Kind::exists, file, "is there already");
  const auto wal = sql::file_exists(file + "-wal", options.vfs);
  if (!wal) return failed(wal.error());
  if (*wal) {
    return store_failure(StoreError::Kind::exists, file,
                         "is missing, but its edits in world.sqlite-wal are there: put it back "
                         "beside them, or move them away to begin anew");
  }
  if (options.vfs.empty()) {  // the files of another VFS need not be on the disk
    if (const auto made = make_file(file); !made) return failed(made.error());
  }
  {
    auto database = sql::Database::open(file, sql::Database::Mode::create, options.vfs);
    if (!database) return failed(database.error());
    if (const auto written = write_new_world(*database, meta, options.sync); !written) {
      return failed(written.error());
    }
  }
  auto store = SqliteStore::open(folder, StoreAccess::read_write, options, *std::move(lock));
  if (!store) return failed(store.error());
  return std::unique_ptr<Store>(*std::move(store));
}

StoreResult<std::unique_ptr<Store>> open_sqlite_world(const std::string& folder, StoreAccess access,
                                                      const SqliteOptions& options) {
  const std::string file = file_in(folder);
  const auto there = sql::file_exists(file, options.vfs);
  if (!there) return failed(there.error());
  if (!*there) return store_failure(StoreError::Kind::not_a_world, file, "is not there");
  if (const auto marked = check_marks(file, options.vfs); !marked) return failed(marked.error());
  FileLock lock;
  if (access != StoreAccess::read_only) {
    auto taken = take_lock(folder, file);
    if (!taken) return failed(taken.error());
    lock = *std::move(taken);
  }
  auto store = SqliteStore::open(folder, access, options, std::move(lock));
  if (!store) return failed(store.error());
  return std::unique_ptr<Store>(*std::move(store));
}

StoreResult<std::unique_ptr<Store>> create_world(const std::string& folder, const WorldMeta& meta,
                                                 const std::string& vfs) {
  return create_sqlite_world(folder, meta, {vfs, true});
}

StoreResult<std::unique_ptr<Store>> open_world(const std::string& folder, StoreAccess access,
                                               const std::string& vfs) {
  return open_sqlite_world(folder, access, {vfs, true});
}

}  // namespace runstone
